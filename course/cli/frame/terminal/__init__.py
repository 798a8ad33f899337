"""The screen: what is printed and paged, pictures, meters, and a reader that goes away."""
