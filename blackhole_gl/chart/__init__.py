"""Measures what methods cost and how far they err, and writes it down: tables, pictures and the page docs/accuracy.md."""
