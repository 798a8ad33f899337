"""An exercise worked on: started, checked, hinted at, reported on, handed in."""
