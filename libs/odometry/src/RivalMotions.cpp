// SPDX-License-Identifier: BSD-3-Clause
#include "RivalMotions.h"

#include <pointplane/core/significance.h>
#include <pointplane/pose/view_cell.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "by_chance.h"

namespace pointplane
{
namespace
{
/** Side of the cells of the view that points stand for, over their depth: 3 degrees. */
constexpr double kCell = 0.05;

/** Squared norms up to which pairs agree. */
struct Limits
{
    double points, planes;
};

template <class Pairs, class Keep>
Pairs chosen(const Pairs& pairs, Keep keep)
{
    Pairs out;
    for (size_t i = 0; i < pairs.size(); ++i)
    {
        if (keep(i))
        {
            out.push_back(pairs[i]);
        }
    }
    return out;
}

/** Motion of the points that disagree with an estimate, of the reference that most of them are of:
 * what moves has another place in each reference, so it has one motion only for one of them.
 * \param limit squared norm up to which points agree */
std::optional<Motion> secondMotion(
    const PoseSolver& solver,
    const PoseProblem& problem,
    const PoseEstimate& estimate,
    double limit)
{
    std::map<int, int> counts;
    const auto disagrees = [&](size_t i) { return estimate.squaredNorms.points[i] > limit; };
    for (size_t i = 0; i < problem.points.size(); ++i)
    {
        counts[problem.points[i].reference] += disagrees(i) ? 1 : 0;
    }
    const auto most = std::max_element(
        counts.begin(),
        counts.end(),
        [](const auto& a, const auto& b) { return a.second < b.second; });
    if (most == counts.end() || most->second < kPointsOfAMotion)
    {
        return {};
    }
    const auto isOfRest = [&](size_t i)
    { return disagrees(i) && problem.points[i].reference == most->first; };
    const PoseProblem rest{chosen(problem.points, isOfRest), {}, problem.prior, problem.noise};
    return solver.solve(rest, estimate.motion.mean).motion.mean;
}

std::vector<Side> sides(
    const std::vector<double>& first, const std::vector<double>& second, double limit)
{
    std::vector<Side> out(first.size());
    for (size_t i = 0; i < first.size(); ++i)
    {
        const bool inFirst = first[i] <= limit, inSecond = second[i] <= limit;
        out[i] = inFirst ? (inSecond ? Side::Both : Side::First)
                         : (inSecond ? Side::Second : Side::Neither);
    }
    return out;
}

/** Finds out which pairs go with which of the two motions. */
void takeSides(
    const PoseSolver& solver, const PoseProblem& problem, const Limits& limits, Rivalry& rivalry)
{
    const SquaredNorms first = solver.squaredNorms(problem, rivalry.first);
    const SquaredNorms second = solver.squaredNorms(problem, rivalry.second);
    rivalry.points = sides(first.points, second.points, limits.points);
    rivalry.planes = sides(first.planes, second.planes, limits.planes);
}

/** One of the two motions, by all pairs that agree with it. */
PoseEstimate refined(
    const PoseSolver& solver, const PoseProblem& problem, const Rivalry& rivalry, Side own)
{
    const auto goes = [own](Side side) { return side == own || side == Side::Both; };
    const PoseProblem ofOwn{
        chosen(problem.points, [&](size_t i) { return goes(rivalry.points[i]); }),
        chosen(problem.planes, [&](size_t i) { return goes(rivalry.planes[i]); }),
        problem.prior,
        problem.noise};
    return solver.solve(ofOwn, own == Side::First ? rivalry.first : rivalry.second);
}

/** Whether a reference tells two motions apart, by enough of its points that agree with any. Both
 * motions need points there: else it is the reference's own pose that is off. */
bool areDistinct(const std::vector<PointPair>& points, const std::vector<Side>& sides)
{
    struct Counts
    {
        int both{0}, first{0}, second{0};
    };
    std::map<int, Counts> counts;
    for (size_t i = 0; i < points.size(); ++i)
    {
        Counts& ofReference = counts[points[i].reference];
        ofReference.both += sides[i] == Side::Both ? 1 : 0;
        ofReference.first += sides[i] == Side::First ? 1 : 0;
        ofReference.second += sides[i] == Side::Second ? 1 : 0;
    }
    return std::any_of(
        counts.begin(),
        counts.end(),
        [](const auto& entry)
        {
            const Counts& c = entry.second;
            const int tell = c.first + c.second;
            return tell >= kNoChanceShare * (tell + c.both) &&
                   std::min(c.first, c.second) >= kPointsOfAMotion;
        });
}

/** Surface of the cells of the view in which points are on one side: [m^2]. */
std::pair<double, double> surfaces(
    const std::vector<PointPair>& points, const std::vector<Side>& sides)
{
    struct Cell
    {
        double first{0}, second{0}, depth{0};
    };
    std::map<std::pair<int, int>, Cell> cells;
    for (size_t i = 0; i < points.size(); ++i)
    {
        const Eigen::Vector3d& p = points[i].cur.mean;
        if (sides[i] != Side::First && sides[i] != Side::Second)
        {
            continue;
        }
        Cell& cell = cells[viewCell(p, kCell)];
        (sides[i] == Side::First ? cell.first : cell.second) += 1;
        cell.depth += p.z();
    }
    std::pair<double, double> out{0, 0};
    for (const auto& [at, cell] : cells)
    {
        const double count = cell.first + cell.second;
        const double side = kCell * cell.depth / count;
        out.first += side * side * cell.first / count;
        out.second += side * side * cell.second / count;
    }
    return out;
}
}  // namespace

bool Rivalry::isClear() const
{
    return std::max(areaFirst, areaSecond) >= kClearlyLarger * std::min(areaFirst, areaSecond);
}

std::optional<Rivalry> findRivalry(
    const PoseSolver& solver,
    const PoseProblem& problem,
    const PoseEstimate& estimate,
    const NoiseFactors& usual)
{
    const double limit2 = solver.tukeySigmas() * solver.tukeySigmas();
    const Limits limits{limit2 * usual.points, limit2 * usual.planes};
    const auto second =
        limit2 > 0 ? secondMotion(solver, problem, estimate, limits.points) : std::nullopt;
    if (!second)
    {
        return {};
    }
    Rivalry out;
    out.first = estimate.motion.mean;
    out.second = *second;
    takeSides(solver, problem, limits, out);
    if (!areDistinct(problem.points, out.points))
    {
        return {};
    }
    const PoseEstimate first = refined(solver, problem, out, Side::First);
    const PoseEstimate other = refined(solver, problem, out, Side::Second);
    out.first = first.motion.mean;
    out.second = other.motion.mean;
    takeSides(solver, problem, limits, out);
    if (!areDistinct(problem.points, out.points) ||
        std::max(first.pointChi2PerDof, other.pointChi2PerDof) > kConvincingRise * usual.points)
    {
        return {};
    }
    std::tie(out.areaFirst, out.areaSecond) = surfaces(problem.points, out.points);
    return out;
}

void leaveLoserOut(const Rivalry& rivalry, std::vector<Association>& associations)
{
    const Side loser = rivalry.firstWins() ? Side::Second : Side::First;
    auto plane = rivalry.planes.begin();
    auto point = rivalry.points.begin();
    for (Association& association : associations)
    {
        const auto split = [](auto& own, auto& moving, auto isLeftOut)
        {
            auto end = own.begin();
            for (auto& pair : own)
            {
                if (isLeftOut())
                {
                    moving.push_back(pair);
                }
                else
                {
                    *end++ = pair;
                }
            }
            own.erase(end, own.end());
        };
        split(association.planes, association.movingPlanes, [&] { return *plane++ == loser; });
        split(
            association.points,
            association.movingPoints,
            [&]
            {
                const Side side = *point++;
                return side == loser || side == Side::Neither;
            });
    }
}
}  // namespace pointplane
