"""Pictures from scenes: the passes and the GL objects they need."""
