"""Pure functions on floats and arrays: ellipse, drops, optics, wind, level of detail, container.

NumPy only; nothing here knows of entities or of OpenGL. What a shader computes too is computed
here first, and tested here.
"""
