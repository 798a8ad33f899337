"""The simulations: each has settings, runs, holds itself against theory and says what it found."""
