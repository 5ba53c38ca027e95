# SPDX-License-Identifier: Apache-2.0
"""The kitchen, one module per group of furniture. Each module's build(scene) adds its nodes."""
