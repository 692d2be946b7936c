# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Offline half: from datasheets to a lookup surface of ball-screw efficiency and asperity contact.

The chain runs parameters -> geometry -> load_sharing -> kinematics -> film_formulas -> friction ->
torque -> closed_form -> build -> surface. Nothing here imports ROS.

"""
