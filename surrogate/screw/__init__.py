# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""One point of the full tier: four contacts, traction, balance of the balls, torque."""
