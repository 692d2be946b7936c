# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Contact of asperities under a raceway that rolls: by the topography of each raceway."""
