"""MOB-Net: limb-modularized uncertainty torque learning for sensorless external torque estimation."""
