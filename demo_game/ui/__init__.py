"""What is drawn over the picture: readout, menus, help, map. Needs pyglet and a window."""
