"""Unions of few convex parts that keep the descriptors of a particle, its convex hull volume among them."""
