"""The simulated plant (section 4.3, Tables 3 and 4)."""

from pydantic import Field

from mobnet.formats.base import NotNegative, Real, Section, Whole


class Rates(Section):
    """Sampling rates, section 4.3."""

    plant_hz: Real = Field(ge=100, le=20_000)
    data_hz: Real = Field(ge=50, le=10_000)


class Friction(Section):
    """Table 4, for the friction law (23)."""

    coulomb_nm: NotNegative = Field(le=500)
    static_nm: NotNegative = Field(le=500)
    stribeck_rad_s: Real = Field(ge=0.001, le=20)
    viscous_legs_nms: NotNegative = Field(le=500)
    viscous_others_nms: NotNegative = Field(le=500)
    load_legs_per_nm: NotNegative = Field(le=0.1)
    loss_legs_nm: NotNegative = Field(le=500)
    loss_others_nm: NotNegative = Field(le=500)


class Noise(Section):
    """Noise of the sensors, Table 3 as printed: standard deviations or variances, as `noise` of a level says."""

    joint_position_rad: NotNegative = Field(le=0.1)
    joint_velocity_rad_s: NotNegative = Field(le=1)
    base_acceleration_m_s2: NotNegative = Field(le=10)
    base_angular_velocity_rad_s: NotNegative = Field(le=1)


class OwnNoise(Section):
    """Errors of sensors that Table 3 does not have, at every level with noise; standard deviations."""

    encoder_step_rad: NotNegative = Field(le=0.01)
    orientation_rad: NotNegative = Field(le=0.1)
    orientation_offset_rad: NotNegative = Field(le=0.1)
    foot_force_n: NotNegative = Field(le=100)
    foot_moment_nm: NotNegative = Field(le=10)


class Plant(Section):
    """Contact, solver, friction, motors and noise of the simulated robot."""

    contact_friction: Real = Field(ge=0.05, le=5)
    sole_stiffness_n_m: Real = Field(ge=1e3, le=1e7)
    sole_damping_ns_m: Real = Field(ge=1, le=1e5)
    contact_grip: Real = Field(ge=1, le=1e4)
    solver_iterations: Whole = Field(ge=1, le=1000)
    solver_tolerance: NotNegative = Field(le=0.001)
    gravity_m_s2: Real = Field(ge=1, le=30)
    friction_smoothing_rad_s: Real = Field(ge=0.0001, le=1)
    friction: Friction
    loss_time_constant_s: Real = Field(ge=0.0001, le=0.5)
    loss_impedance: Real = Field(ge=0.5, le=0.999)
    motor_limit_min_nm: NotNegative = Field(le=2000)
    noise: Noise
    own_noise: OwnNoise
