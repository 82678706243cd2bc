"""Statistical models of evaluated designs: predictions with error bands, and what a new design may be worth."""
