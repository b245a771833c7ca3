"""GLSL text: composition from files, and uniform blocks made from one declaration."""
