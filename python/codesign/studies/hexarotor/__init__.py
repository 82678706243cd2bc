"""A hexarotor with tilted rotors on tube arms: no joints, six propellers."""
