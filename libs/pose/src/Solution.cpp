// SPDX-License-Identifier: BSD-3-Clause
#include "Solution.h"

namespace pointplane
{
namespace
{
/** \param offset of the pairs' first residual */
template <class Pairs>
Solution::References byReference(
    const NormalEquations& equations, const Pairs& pairs, size_t offset)
{
    Solution::References out;
    for (size_t i = 0; i < pairs.size(); ++i)
    {
        equations.add(out[pairs[i].reference], offset + i);
    }
    return out;
}
}  // namespace

Solution solutionOf(
    const NormalEquations& equations,
    const PoseProblem& problem,
    const Matrix12d& H,
    const Matrix12d& H_inverse)
{
    return {
        equations,
        problem,
        H,
        H_inverse,
        byReference(equations, problem.points, 0),
        byReference(equations, problem.planes, problem.points.size())};
}
}  // namespace pointplane
