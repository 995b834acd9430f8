// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace pointplane
{
/** P(X <= x) of the chi-square distribution. \param dof > 0 */
[[nodiscard]] double chiSquareCdf(double x, double dof);

/** The x with P(X <= x) = probability, to 1e-9 relative up to 1000 degrees of freedom; beyond, by
 * Wilson and Hilferty's cube-root approximation (1e-5 relative there).
 * \param probability in (0, 1) */
[[nodiscard]] double chiSquareQuantile(double probability, double dof);
}  // namespace pointplane
