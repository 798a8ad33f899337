"""The screen: printing and paging, its text, pictures, progress bars, a pipe whose reader goes away."""
