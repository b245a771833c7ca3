# make view · make test: each sets up all it needs first. GNU make, POSIX sh.

PYTHON      ?=
VENV        ?= .venv
WORKERS     ?= 2
PRESET      ?=
PYTEST_ARGS ?=
CHART_ARGS  ?=
STABILITY_ARGS ?=
FLIGHT_ARGS ?=
PYTHONS     ?= python3.11 python3.12 python3.13 python3.14

BIN := $(VENV)/$(if $(filter Windows_NT,$(OS)),Scripts,bin)
SETUP := VENV='$(VENV)' PYTHON='$(PYTHON)' sh tools/setup.sh

.DEFAULT_GOAL := help
.PHONY: help setup view test test-slow test-pythons gallery thumbnails api-page site chart fields media stability flight clean

help: ## list the targets
	@echo 'Blackhole GL'
	@sed -n 's/^\([a-z-]*\):[^#]*## \(.*\)/  make \1|\2/p' $(firstword $(MAKEFILE_LIST)) | awk -F'|' '{ printf "%-20s %s\n", $$1, $$2 }'
	@echo 'Settings: PYTHON=python3.12  VENV=.venv  PRESET=kerr (view)  WORKERS=2  PYTEST_ARGS="tests/unit -x" (test)'

setup: ## the virtual environment and the GL libraries, no more
	@$(SETUP) run

view: ## open the viewer; without a display, write a picture
	@$(SETUP) run
	@$(BIN)/blackhole-gl view $(if $(PRESET),--preset $(PRESET))

test: ## run the whole test suite
	@$(SETUP) test
	$(BIN)/python -m pytest -n $(WORKERS) $(PYTEST_ARGS)

gallery: ## the pictures of the README anew, into docs/pictures
	@$(SETUP) run
	$(BIN)/python tools/make_gallery.py

thumbnails: ## the small pictures of the panel's pickers anew, into assets/thumbnails
	@$(SETUP) run
	$(BIN)/python tools/make_thumbnails.py

api-page: ## docs/python_reference.md anew, from the docstrings
	@$(SETUP) run
	$(BIN)/python tools/make_api_page.py

site: ## the documentation as pages for a browser that need no network: build/site/index.html
	@$(SETUP) site
	$(BIN)/python -m sphinx -q -W --keep-going -n -d build/site.kept -c docs/site . build/site

chart: ## measure every method: docs/accuracy.md, its charts, and the table the plan chooses by
	@$(SETUP) chart
	$(BIN)/python -m studies.chart --out docs --plan-table assets/measurements.csv $(CHART_ARGS)

fields: ## measure every method in every field: docs/fields.md and the table the plan chooses by
	@$(SETUP) run
	$(BIN)/python -m studies.fields --out docs --plan-table assets/measurements_fields.csv

media: ## measure steps in every kind of medium: docs/media.md and the table the plan chooses by
	@$(SETUP) run
	$(BIN)/python -m studies.media --out docs --plan-table assets/measurements_media.csv

test-slow: ## the tests that take minutes: ten thousand rays, a million rays, 8K pictures, the whole flight, other drivers
	@$(SETUP) test
	$(BIN)/python -m pytest -n $(WORKERS) -m slow $(PYTEST_ARGS)

test-pythons: ## unit tests and golden pictures by every interpreter of PYTHONS, each in an environment of its own
	@for python in $(PYTHONS); do $(MAKE) test PYTHON=$$python VENV=.venv-$$python PYTEST_ARGS='tests/unit tests/images' || exit 1; done

stability: ## every method through the cases where methods fail: docs/stability.md and its data; STABILITY_ARGS="--only kerr"
	@$(SETUP) run
	$(BIN)/python -m studies.make_stability_page $(STABILITY_ARGS)

flight: ## ten seconds round the hole, refined and exact: docs/data/flight.csv and its plot; FLIGHT_ARGS="-p m87_like --fps 2 --out ."
	@$(SETUP) chart
	$(BIN)/python -m studies.fly $(FLIGHT_ARGS)

clean: ## remove the virtual environment and what builds and tests left
	rm -rf $(VENV) $(addprefix .venv-,$(PYTHONS)) build dist .pytest_cache .ruff_cache .hypothesis tests/output
	find blackhole_gl studies tests tools -name __pycache__ -type d -exec rm -rf {} +
