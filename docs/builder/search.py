"""What the search of the site finds first: other words for pages, and the weight of folders."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

#: Words that a reader may type and the title does not have, by page.
WORDS = {
    "begin": "getting started",
    "install": "pip, wheel, requirements, compile",
    "start": "first model, quick start, hello world",
    "decisions": "large deformation, mixed mesh, plane strain, plane stress, "
    "why does it not converge, does not converge, no convergence, cut-backs, diverges, "
    "which element, which strain, which step, locking",
    "rubber": "elastomer, hyperelastic, neo-hooke, mooney-rivlin, yeoh, ogden, incompressible",
    "contact": "friction, coulomb, mortar, rigid curve, tie, penalty",
    "impact": "drop, crash, bounce",
    "paths": "arc length, riks, snap-through, limit point, bifurcation, limit load",
    "plasticity": "yield, yield stress, hardening, mises, creep, von mises",
    "dynamics": "frequency, natural frequency, natural frequencies, eigenfrequency, modes, "
    "damping, newmark, harmonic response",
    "thermal": "thermal, temperature, thermal expansion, heat",
    "constraints": "equation, rigid body, coupling, hinge joint, periodic",
    "line-elements": "beam, truss, spring, frame",
    "reduced-integration": "cps4r, cpe4r, hourglass",
    "output": "export csv, csv, reaction force, reactions, units, results, vtk, paraview, frd",
    "restart": "checkpoint, resume",
    "scale": "parallel, speed, memory, large models, petsc, threads",
    "howto/snap_fit": "pull-out force, retention force, clip, latch, detent, insertion force, "
    "cantilever snap",
    "howto/cable_clip": "cable clip, pipe clip",
    "howto/detent": "detent, click, bump",
    "howto/hose_clamp": "hose clamp, band brake, tightening",
    "howto/constant_force": "constant force, shape optimization",
    "howto/crushed_tube": "crushing, honeycomb cell, energy absorber",
    "howto/corner_drop": "drop of a corner, rebound",
    "howto/flexure": "dxf, step file, outline, drawing, stiffness, symmetric half model, hinge, "
    "compliant mechanism, flexure hinge",
    "howto/bistable_switch": "second stable position, double v-beam, bistable, two stable shapes",
    "howto/mems": "electrostatic, comb drive, pull-in",
    "howto/joints": "pivot, notch, parallelogram, cosine beam",
    "howto/tolerances": "scatter, yield of parts, sensitivity",
    "howto/seal": "gasket, tube",
    "howto/press_fit": "press fit, shrink fit, shrinking, interference, overlap, hub, shaft",
    "howto/steps": "springback, spring back, release a support, let go, remove a load, unload, "
    "several steps, step sequence, forming",
    "howto/o_ring": "o-ring, cord, groove",
    "howto/living_hinge": "living hinge, fold",
    "howto/thermal_actuator": "chevron, mems, actuator",
    "howto/buckling": "critical load, column",
    "howto/impact": "drop test",
    "howto/from_abaqus": "abaqus, inp",
    "howto/from_calculix": "calculix, ccx",
    "howto/thermal_bow": "bimetal",
    "howto/vibration": "resonance, tuning fork, vibration, natural frequency, eigenfrequency",
    "tutorial": "prescribed displacement, fix rotation, pressure load, thickness",
    "howto/user_material": "umat, user material",
    "howto/user_term": "uel, user element, magnetic damper, eddy current",
    "howto/sweep": "optimization, parameters, design of experiments",
    "axisymmetry": "axisymmetric, turned parts, solid of revolution",
    "cells": "homogenization, Bloch, metamaterial, lattice, unit cell",
    "gradients": "sensitivity, adjoint, optimizer",
    "limits": "creep, crack, 3d, limitations",
    "other-programs": "alternatives, comparison with other programs",
}


def with_words(name: str, text: str) -> str:
    """The text of a page with an entry of the index for each of its words below its heading."""
    if name not in WORDS or not text.startswith("# "):
        return text
    heading, _, rest = text.partition("\n")
    entries = "\n".join(f"   ! single: {word.strip()}" for word in WORDS[name].split(","))
    return f"{heading}\n\n```{{eval-rst}}\n.. index::\n{entries}\n```\n{rest}"


__all__ = ["WORDS", "with_words"]
