"""The simulated plant and its uncertainty levels (sections 4.3 and 5.1, Tables 3 and 4)."""

from typing import Literal

from mobnet.settings.base import Count, NotNegative, Positive, Section

FrictionTerm = Literal["stribeck", "load", "loss"]


class Rates(Section):
    """Sampling rates, section 4.3."""

    plant_hz: Positive
    data_hz: Positive


class Friction(Section):
    """Table 4, for the friction law (23)."""

    coulomb_nm: NotNegative
    static_nm: NotNegative
    stribeck_rad_s: Positive
    viscous_legs_nms: NotNegative
    viscous_others_nms: NotNegative
    load_legs_per_nm: NotNegative
    loss_legs_nm: NotNegative
    loss_others_nm: NotNegative


class NoiseStd(Section):
    """Table 3, read as standard deviations."""

    joint_position_rad: NotNegative
    joint_velocity_rad_s: NotNegative
    base_acceleration_m_s2: NotNegative
    base_angular_velocity_rad_s: NotNegative


class Plant(Section):
    """Contact, solver, friction, motors and noise of the simulated robot."""

    contact_friction: Positive
    contact_time_constant_s: Positive
    contact_damping_ratio: Positive
    solver_iterations: Count
    solver_tolerance: NotNegative
    gravity_m_s2: Positive
    friction_smoothing_rad_s: Positive
    friction: Friction
    motor_limit_min_nm: NotNegative
    noise_std: NoiseStd


class Level(Section):
    """An uncertainty level of section 5.1: which errors the plant has and what the observer's model gets wrong."""

    friction: tuple[FrictionTerm, ...]
    noise: Literal["none", "std", "variance"]
    nominal_mass_ratio: Positive
    base_state: Literal["true_state", "sensed"]
