"""Three-dimensional views: one protocol, a live backend on OpenGL and one that draws into pictures."""
