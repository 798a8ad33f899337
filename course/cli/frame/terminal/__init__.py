"""The screen: printing and paging, pictures, progress bars, and a pipe whose reader goes away."""
