"""Flights of the predictive controller against an independent implementation, and ablations that must fail.

The robots of the two have other tessellations: trim thrusts differ by 0.07 N. Figures have two to four digits.
"""

from functools import cache

import numpy as np
import pytest

import ironcub_predictive as whole
from codesign import dynamics as dyn

PULSES = {f"{kind}{axis}": (kind, i) for kind in ("force ", "moment ") for i, axis in enumerate("xyz")}


def pulse(name: str) -> dyn.Pulse:
    """50 N for 0.5 s through the center of mass or 300 N m for 0.02 s, along an axis."""
    kind, axis = PULSES[name]
    unit = np.eye(3)[axis]
    if kind == "force ":
        return dyn.Pulse(start=0.5, duration=0.5, force=50.0 * unit)
    return dyn.Pulse(start=0.5, duration=0.02, moment=300.0 * unit)


@cache
def flown(flight: str, recommended: bool, reference: bool = True) -> dyn.FlightLog:
    settings = whole.settings(recommended, reference)
    if flight == "route":
        settings.path = whole.route()
    elif flight == "step":
        settings.path, settings.duration = whole.step(), 10.0
    elif flight == "hover":
        settings.duration = 10.0
    else:
        settings.pulses, settings.duration = [pulse(flight)], 8.0
    return dyn.simulate_flight(whole.robot(), settings)


# flight, recommended: center of mass rms, largest, at the end [m]; attitude rms, largest [deg]; thrusts [N]; energy
# [J]; fuel [kg]
REFERENCE = {
    ("step", False): (0.0737, 0.2449, 0.0298, 1.303, 2.68, 162, 179, 16.9, 0.3152),
    ("step", True): (0.0740, 0.2449, 0.0208, 0.689, 2.16, 161, 179, 13.8, 0.3150),
    ("route", False): (0.0562, 0.1256, 0.0208, 1.173, 3.60, 159, 185, 32.1, 0.9525),
    ("route", True): (0.0570, 0.1290, 0.0084, 1.264, 3.42, 160, 185, 18.7, 0.9544),
    ("force x", True): (0.0561, 0.1655, 0.0053, 1.386, 3.58, 162, 182, 7.2, 0.2543),
    ("force y", True): (0.0513, 0.1539, 0.0090, 1.277, 3.35, 162, 181, 8.3, 0.2541),
    ("force z", True): (0.0455, 0.1402, 0.0097, 0.450, 0.73, 163, 187, 19.9, 0.2584),
    ("moment x", True): (0.0538, 0.1342, 0.0440, 4.120, 11.68, 156, 189, 47.9, 0.2539),
    ("moment y", True): (0.0751, 0.1793, 0.0227, 3.070, 9.63, 164, 179, 72.2, 0.2547),
    ("moment z", True): (0.0523, 0.1065, 0.0253, 5.246, 25.77, 161, 182, 65.0, 0.2522),
    ("force x", False): (0.0748, 0.1415, 0.0122, 2.439, 4.13, 157, 185, 19.3, 0.2534),
    ("force y", False): (0.0445, 0.1295, 0.0092, 1.402, 3.67, 158, 183, 13.9, 0.2533),
    ("force z", False): (0.0536, 0.1404, 0.0539, 1.030, 2.46, 163, 187, 20.4, 0.2581),
    ("moment x", False): (0.0815, 0.1285, 0.0171, 3.748, 11.99, 147, 194, 54.8, 0.2528),
    ("moment y", False): (0.1018, 0.1811, 0.0444, 3.171, 9.82, 162, 182, 61.0, 0.2549),
    ("moment z", False): (0.0593, 0.1237, 0.0382, 4.586, 22.55, 162, 182, 101.8, 0.2524),
}
FAST = [("step", False), ("step", True), ("moment z", True)]
SLOW = [pytest.param(*key, marks=pytest.mark.slow) for key in REFERENCE if key not in FAST]


@pytest.mark.parametrize(("flight", "recommended"), [*FAST, *SLOW])
def test_flight_agrees_with_an_independent_implementation(flight: str, recommended: bool) -> None:
    log = flown(flight, recommended)
    rms, largest, end, attitude, most_attitude, least, most, energy, fuel = REFERENCE[flight, recommended]
    measured, relative = log.measures, 0.002 if flight in ("route", "step") else 0.01
    assert log.completed
    for value, wanted, decimals in (
        (measured.com_error_rms, rms, 1e-4),
        (measured.max_com_error, largest, 1e-4),
        (np.rad2deg(measured.attitude_error_rms), attitude, 1e-3),
        (np.rad2deg(measured.max_attitude_error), most_attitude, 1e-2),
    ):
        assert value == pytest.approx(wanted, rel=relative, abs=0.5 * decimals)
    assert measured.final_com_error == pytest.approx(end, abs=2e-3)
    assert measured.final_com_error < 0.06
    assert (log.min_thrust, log.max_thrust) == pytest.approx((least, most), abs=0.6)
    assert measured.mechanical_energy == pytest.approx(energy, rel=0.01, abs=0.05)
    assert measured.fuel == pytest.approx(fuel, abs=1e-4 * fuel + 0.5e-4)  # and half of the last printed digit


def test_the_implicit_plant_flies_as_the_reference() -> None:
    fine, quick = flown("step", True).measures, flown("step", True, reference=False).measures
    assert quick.com_error_rms == pytest.approx(fine.com_error_rms, rel=0.005)
    assert quick.attitude_error_rms == pytest.approx(fine.attitude_error_rms, rel=0.01)
    assert quick.fuel == pytest.approx(fine.fuel, rel=1e-4)


@pytest.mark.slow
def test_route_at_five_times() -> None:
    log = flown("route", True)
    wanted = {
        4: (0.0213, -0.0004, 1.2300, -0.014, 12.768, -0.008, 182.30, 182.67, 167.15, 167.64),
        9: (0.3666, 0.1758, 1.8873, -0.713, 14.478, 0.065, 181.36, 180.93, 165.00, 164.31),
        12: (1.8783, 0.9306, 2.2594, 0.834, 11.101, 0.034, 178.61, 179.40, 164.43, 165.40),
        16: (2.0192, 1.0009, 2.3094, 0.041, 12.752, 15.871, 178.42, 178.64, 164.16, 164.83),
        19: (2.0173, 0.9996, 2.3053, -0.066, 12.824, 60.063, 178.54, 178.98, 164.37, 165.05),
    }
    for time, row in wanted.items():
        k = round(time / 0.005)
        np.testing.assert_allclose(log.com[k], row[:3], atol=1e-3)
        np.testing.assert_allclose(log.thrust[k], row[6:], atol=0.1)


def test_a_trimmed_hover_stays() -> None:
    log = flown("hover", False, reference=False)
    assert log.completed
    assert log.measures.max_com_error < 1e-9


def ablated(flight: str, recommended: bool, **changed: bool) -> dyn.FlightLog:
    settings = whole.settings(recommended)
    if flight == "route":
        settings.path = whole.route()
    else:
        settings.pulses, settings.duration = [pulse("force x")], 8.0
    options = {"gravity_coupling": recommended, "jet_dynamics": True, "varying": True} | changed
    settings.predictive.model = dyn.PredictiveModelOptions(**options)
    return dyn.simulate_flight(whole.robot(), settings)


@pytest.mark.slow
@pytest.mark.parametrize("recommended", [False, True])
@pytest.mark.parametrize("left_out", ["jet_dynamics", "varying"])
def test_without_jets_or_varying_model_the_route_is_lost(left_out: str, recommended: bool) -> None:
    log = ablated("route", recommended, **{left_out: False})
    assert not log.completed and log.failure_time is not None
    assert 5.0 < log.failure_time < 15.0


@pytest.mark.slow
@pytest.mark.parametrize(("recommended", "factor"), [(False, 4.0), (True, 10.0)])
def test_a_single_rate_shakes_the_joints(recommended: bool, factor: float) -> None:
    settings = whole.settings(recommended)
    settings.path = whole.route()
    predictive = settings.predictive
    settings.step = predictive.period = 0.1
    predictive.throttle_every, predictive.small_steps, predictive.control_steps = 1, 1, 6
    settings.predictive = predictive
    log = dyn.simulate_flight(whole.robot(), settings)
    multi_rate = flown("route", recommended).measures.mechanical_energy
    assert not log.completed or log.measures.mechanical_energy >= factor * multi_rate
