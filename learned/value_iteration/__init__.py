"""Value iteration as a part of networks: its equations, and fast loops that are proved equal to them."""
