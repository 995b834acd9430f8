// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/evaluation/chi_square.h>

#include <Eigen/Core>

#include <cmath>

#include <unsupported/Eigen/SpecialFunctions>

namespace pointplane
{
namespace
{
constexpr double kExactUpToDof = 1000;  // the series of igamma needs ever more terms

/** Standard normal quantile by bisection of erfc: a few digits more than any table, and no
 * formula to mistrust. */
double normalQuantile(double probability)
{
    double low = -40;
    double high = 40;
    for (int k = 0; k < 100; ++k)
    {
        const double middle = 0.5 * (low + high);
        (0.5 * std::erfc(-middle / std::sqrt(2.0)) < probability ? low : high) = middle;
    }
    return 0.5 * (low + high);
}
}  // namespace

double chiSquareCdf(double x, double dof)
{
    POINTPLANE_CHECK(dof > 0, "chi-square with " << dof << " degrees of freedom");
    return x <= 0 ? 0 : Eigen::numext::igamma(0.5 * dof, 0.5 * x);
}

double chiSquareQuantile(double probability, double dof)
{
    POINTPLANE_CHECK(
        probability > 0 && probability < 1, "chi-square quantile of probability " << probability);
    POINTPLANE_CHECK(dof > 0, "chi-square with " << dof << " degrees of freedom");
    if (dof > kExactUpToDof)
    {
        const double v = 2 / (9 * dof);
        return dof * std::pow(1 - v + normalQuantile(probability) * std::sqrt(v), 3);
    }
    double low = 0;
    double high = dof;
    while (chiSquareCdf(high, dof) < probability)
    {
        high *= 2;
    }
    for (int k = 0; k < 100; ++k)
    {
        const double middle = 0.5 * (low + high);
        (chiSquareCdf(middle, dof) < probability ? low : high) = middle;
    }
    return 0.5 * (low + high);
}
}  // namespace pointplane
