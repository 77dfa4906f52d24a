"""What adds to the residual and the tangent of the equations."""

# SPDX-License-Identifier: BSD-3-Clause
