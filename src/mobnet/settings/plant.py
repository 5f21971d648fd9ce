"""The simulated plant and its uncertainty levels (sections 4.3 and 5.1, Tables 3 and 4)."""

from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from mobnet.settings.base import NotNegative, Real, Section, Whole, distinct

FrictionTerm = Literal["stribeck", "load", "loss"]


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


class NoiseStd(Section):
    """Table 3, read as standard deviations."""

    joint_position_rad: NotNegative = Field(le=0.1)
    joint_velocity_rad_s: NotNegative = Field(le=1)
    base_acceleration_m_s2: NotNegative = Field(le=10)
    base_angular_velocity_rad_s: NotNegative = Field(le=1)


class Plant(Section):
    """Contact, solver, friction, motors and noise of the simulated robot."""

    contact_friction: Real = Field(ge=0.05, le=5)
    contact_time_constant_s: Real = Field(ge=0.0001, le=0.5)
    contact_damping_ratio: Real = Field(ge=0.05, le=10)
    solver_iterations: Whole = Field(ge=1, le=1000)
    solver_tolerance: NotNegative = Field(le=0.001)
    gravity_m_s2: Real = Field(ge=1, le=30)
    friction_smoothing_rad_s: Real = Field(ge=0.0001, le=1)
    friction: Friction
    motor_limit_min_nm: NotNegative = Field(le=2000)
    noise_std: NoiseStd


class Level(Section):
    """An uncertainty level of section 5.1: which errors the plant has and what the observer's model gets wrong."""

    friction: Annotated[tuple[FrictionTerm, ...], AfterValidator(distinct)]
    noise: Literal["none", "std", "variance"]
    nominal_mass_ratio: Real = Field(ge=0.3, le=3)
    base_state: Literal["true_state", "sensed"]
