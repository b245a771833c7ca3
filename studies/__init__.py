"""What measures the project and writes its documents. Runs from a checkout; nothing of it travels in the wheel."""
