# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The rough surface of a case: by formula, by the standard or measured, and what is said of it."""

from dataclasses import fields, replace
import math

import numpy as np
from surrogate.contact.case import CaseRoughness, CONSTANTS, ContactCase
from surrogate.files import InputError
from surrogate.formulas.geometry import hertz
from surrogate.raceway.ball import ball_of, draw_pair
from surrogate.raceway.fractal import fractal_surface, FractalSurface, PublishedRoughness, shifted
from surrogate.raceway.import_file import read_surface
from surrogate.raceway.measured import MeasuredSurface
from surrogate.raceway.patch import Raceway, take_patch, Window
from surrogate.raceway.scaling import draw_raceway, scale_spectrum, ScaledSpectrum
from surrogate.raceway.short_waves import wave_rms, without_short_waves
from surrogate.raceway.spectrum import RoughnessSpectrum
from surrogate.raceway.stated import BallRoughness
from surrogate.units import MICRO, NANO


def case_surface(case: ContactCase) -> Raceway | None:
    """Return the rough surface of a case as the contact sees it, None when it is smooth."""
    rough = case.roughness
    if rough is None or (rough.file is None and not rough.rms):
        return None
    if rough.patch == 'standard':
        draw = _all_waves(rough)
        if rough.shortest_wavelength is not None:
            draw = without_short_waves(draw, rough.shortest_wavelength)
        return _at_place(draw, rough)
    ellipse = hertz(case.contact, case.load)
    window = Window(
        length_x=rough.window_x or 2 * float(ellipse.semi_axis_x),
        length_y=rough.window_y or 2 * float(ellipse.semi_axis_y),
    )
    if rough.file is None:
        given = {name: getattr(rough, name) for name in CONSTANTS}
        constants = {name: value for name, value in given.items() if value is not None}
        waves = PublishedRoughness(**constants)
        draw = fractal_surface(waves, rough.seed or 0, lay=rough.lay or 'isotropic')
        placed = _at_place(draw, rough)
        return take_patch(placed, rough.patch or 'rescaled', window, rough.rms or 0.0)
    kind = rough.patch or ('rescaled' if rough.rms else 'cut')
    return take_patch(_measured(rough, rough.file), kind, window, rough.rms or 0.0)


def _measured(rough: CaseRoughness, file: str) -> MeasuredSurface:
    return read_surface(file, shortest_wavelength=rough.shortest_wavelength, outside=rough.outside)


def _at_place(draw: FractalSurface, rough: CaseRoughness) -> FractalSurface:
    return shifted(draw, rough.position_x or 0.0, rough.position_y or 0.0)


def _all_waves(rough: CaseRoughness) -> FractalSurface:
    """Return the draw of raceway and ball with the waves that the grid may not hold."""
    raceway = raceway_waves(rough)
    ball, seed = ball_waves_of(rough), rough.seed or 0
    return draw_raceway(raceway, seed) if ball is None else draw_pair(raceway, ball, seed)


def _spectrum(rough: CaseRoughness) -> RoughnessSpectrum:
    names = [spec.name for spec in fields(RoughnessSpectrum)]
    stated = {name: getattr(rough, name) for name in names if getattr(rough, name) is not None}
    return RoughnessSpectrum(**stated)


def raceway_waves(rough: CaseRoughness) -> ScaledSpectrum:
    """Return the scaled waves of a raceway by the standard; raises InputError."""
    spectrum = _spectrum(rough)
    cutoff, shortest = spectrum.cutoff_short, rough.shortest_wavelength
    if shortest is not None and shortest < cutoff * (1 - 1e-9):
        raise InputError(
            f'roughness: shortest wavelength is {MICRO * shortest:g} um, allowed is the short '
            f'cut-off ({MICRO * cutoff:g} um) or more: there are no shorter waves'
        )
    return scale_spectrum(spectrum)


def ball_waves_of(rough: CaseRoughness) -> ScaledSpectrum | None:
    """Return the scaled waves of the ball, None where it is smooth."""
    if rough.ball_rms is None and rough.ball_grade is None:
        return None
    return ball_of(_spectrum(rough), BallRoughness(rms=rough.ball_rms, grade=rough.ball_grade))


def composite_rms(rough: CaseRoughness) -> float:
    """Return the stated Rq of the raceway, with that of a ball the root of the squares [m]."""
    ball = ball_waves_of(rough)
    return math.hypot(rough.rms or 0.0, ball.rms if ball else 0.0)


def level_surface(surface: FractalSurface) -> FractalSurface:
    """
    Return a patch as it rolls: its waves about their mean, without the slope of the patch.

    A patch is levelled over one window; the plane of that would climb for ever along a track.

    """
    mean = float(np.sum(surface.amplitude * np.cos(surface.phase)))
    return replace(surface, plane=(mean, 0.0, 0.0))


def roughness_words(rough: CaseRoughness | None, surface: Raceway | None) -> str:
    """Say what a rough surface stands for, in one sentence."""
    if rough is None or surface is None:
        return 'none'
    if rough.patch == 'standard':
        raceway = raceway_waves(rough)
        words = f'{raceway.sentence}, G {NANO * raceway.fractal_roughness:.3g} nm'
        ball = ball_waves_of(rough)
        if ball is not None:
            grade = f' {rough.ball_grade}' if rough.ball_grade else ''
            words += f'; ball{grade} {ball.sentence}'
        shortest = rough.shortest_wavelength
        if shortest is None:
            return words
        whole = _all_waves(rough)
        kept = wave_rms(without_short_waves(whole, shortest))
        lost = math.sqrt(max(wave_rms(whole) ** 2 - kept**2, 0.0))
        return words + (
            f'; waves shorter than {MICRO * shortest:g} um, rms {NANO * lost:.3g} nm, are left out'
        )
    return (
        f'patch {surface.patch}, heights times {surface.scale:.4g}, shortest wavelength '
        f'{MICRO * surface.shortest_wavelength:.3g} um'
    )
