"""The GPU side: context, state guard, shaders, buffers, passes. The only importer of moderngl."""
