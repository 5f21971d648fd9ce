"""The robot: one table of figures, the plant (MuJoCo), the nominal model (Pinocchio) and what follows from them."""
