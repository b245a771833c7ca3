"""The window: the only code that imports imgui or opens glfw windows. Nothing is imported here, so that headless use stays light."""
