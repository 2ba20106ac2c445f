# SPDX-License-Identifier: MIT
"""Surfaces by formula, as arrays."""
import numpy as np


def grid(columns, rows):
    """(u, v) of a grid in [0, 1]² and its triangles, counter-clockwise."""
    u, v = np.meshgrid(np.linspace(0, 1, columns + 1), np.linspace(0, 1, rows + 1))
    first = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    right, above = first + 1, first + columns + 1
    triangles = np.vstack([np.column_stack([first, right, above + 1]), np.column_stack([first, above + 1, above])])
    return np.column_stack([u.ravel(), v.ravel()]), triangles


def plane(columns=8, rows=8, width=40.0, height=40.0):
    uv, triangles = grid(columns, rows)
    return np.column_stack([uv[:, 0] * width, uv[:, 1] * height, np.zeros(len(uv))]), triangles


def half_cylinder(columns=60, rows=20, radius=30.0, length=80.0):
    """With its isometric (u, v) in millimetres."""
    uv, triangles = grid(columns, rows)
    angle = np.pi * uv[:, 0]
    positions = np.column_stack([-radius * np.cos(angle), length * uv[:, 1], radius * np.sin(angle)])
    return positions, triangles, np.column_stack([radius * angle, length * uv[:, 1]])


def cap(columns=40, rows=40, radius=30.0):
    """A piece of a sphere, curved in both directions."""
    uv, triangles = grid(columns, rows)
    plan = (uv - 0.5) * radius
    return np.column_stack([plan, np.sqrt(radius**2 - (plan**2).sum(1))]), triangles


def bumps(columns, rows, amplitude=0.03):
    uv, triangles = grid(columns, rows)
    height = amplitude * np.sin(40 * uv[:, 0]) * np.cos(30 * uv[:, 1])
    return 100 * np.column_stack([uv, height]), triangles


def cube(side=30.0):
    """A closed surface of twelve triangles."""
    corners = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], float) * side
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return corners, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
