"""Blackhole GL: an interactive viewer of black holes whose pictures can be trusted."""
