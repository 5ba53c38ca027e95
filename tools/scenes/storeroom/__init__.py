# SPDX-License-Identifier: Apache-2.0
"""The storeroom: shapes, the things made of them, and where they lie."""
