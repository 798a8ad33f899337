"""What every figure is drawn with: the house style, shared plots, the text beside it, sixels."""
