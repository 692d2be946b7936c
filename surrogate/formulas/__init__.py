# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Published laws of the ball screw, a function each; closed_form chains them to a tier."""
