"""The differentiable neural computer: its equations, and fast loops that are proved equal to them."""
