// SPDX-License-Identifier: BSD-3-Clause
#include "matchers.h"

#include <pointplane/core/se3.h>

#include <sstream>

namespace pointplane::test
{
bool areNear(
    const Eigen::MatrixXd& actual,
    const Eigen::MatrixXd& expected,
    double tolerance,
    std::string& explanation)
{
    std::ostringstream out;
    if (actual.rows() != expected.rows() || actual.cols() != expected.cols())
    {
        out << "size " << actual.rows() << "x" << actual.cols();
        explanation = out.str();
        return false;
    }
    const double worst = (actual - expected).cwiseAbs().maxCoeff();
    out << "largest difference " << worst << "\nactual:\n" << actual << "\nexpected:\n" << expected;
    explanation = out.str();
    return actual.allFinite() && expected.allFinite() && worst <= tolerance;
}

bool areNear(
    const Eigen::Isometry3d& actual,
    const Eigen::Isometry3d& expected,
    double rad,
    double m,
    std::string& explanation)
{
    const double angle = so3Log(expected.linear().transpose() * actual.linear()).norm();
    const double distance = (actual.translation() - expected.translation()).norm();
    std::ostringstream out;
    out << "rotation off by " << angle << " rad, translation by " << distance << " m";
    explanation = out.str();
    return angle <= rad && distance <= m;
}
}  // namespace pointplane::test
