"""Shared by every figure: the house style, plots described as data, a student's curves, sixels."""
