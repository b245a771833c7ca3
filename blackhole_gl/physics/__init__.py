"""Closed forms, frames and profiles in float64: what is one number a picture."""
