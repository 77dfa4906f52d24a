"""Tables as text: .dat, .sta, .cvg and CSV histories."""

# SPDX-License-Identifier: BSD-3-Clause
