"""Body and predictive controller of a flying humanoid, together."""
