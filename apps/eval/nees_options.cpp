// SPDX-License-Identifier: BSD-3-Clause
#include "nees_options.h"

#include <pointplane/core/number_text.h>
#include <pointplane/evaluation/units.h>

#include <algorithm>
#include <ostream>

#include "input_options.h"
#include "number_checks.h"

namespace pointplane
{
namespace
{
constexpr double kLargestSigma = 1000;    // [m] whose square is far from overflow
constexpr double kLargestSigmaDeg = 180;  // no rotation is larger

/** Standard deviations [rad] from "s" or "x,y,z" [deg]. */
Eigen::Vector3d sigmaFromOption(const std::string& text)
{
    std::vector<double> v = numbersFromOption(text);
    if (v.size() == 1)
    {
        v.resize(3, v.front());
    }
    const auto isSigma = [](double value) { return value >= 0 && value <= kLargestSigmaDeg; };
    if (v.size() != 3 || !std::all_of(v.begin(), v.end(), isSigma))
    {
        throw std::invalid_argument(
            "--gt-sigma-rot-deg: '" + text +
            "' is neither a standard deviation in deg nor three as x,y,z (from 0 to 180)");
    }
    return Eigen::Vector3d(v[0], v[1], v[2]) / kDegreesPerRadian;
}
}  // namespace

void NeesCommandOptions::addTo(CLI::App& command)
{
    addProtocolTo(command);
    command.add_option("--min-nees", minNees, "Exit with 1 if a joint NEES per dof is below this")
        ->check(isNotNegative())
        ->group("Limits");
    command.add_option("--max-nees", maxNees, "Exit with 1 if a joint NEES per dof is above this")
        ->check(isNotNegative())
        ->group("Limits");
}

void NeesCommandOptions::addProtocolTo(CLI::App& command)
{
    command
        .add_option(
            "--interval",
            intervals,
            "Lengths of the increments: frames (10f), seconds (1s), or start (since the first "
            "pose)")
        ->type_name("LENGTH,...")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->capture_default_str()
        ->each([this](const std::string&) { areChosen = true; })
        ->group("Protocol");
    command
        .add_option(
            "--gt-sigma-trans",
            nees.truthSigmaTranslation,
            "Standard deviation of each ground-truth position, per axis [m]")
        ->capture_default_str()
        ->check(isBetween(0, kLargestSigma))
        ->group("Protocol");
    command
        .add_option(
            "--gt-sigma-rot-deg",
            sigmaRotationDeg,
            "Standard deviation of each ground-truth rotation [deg]: one for all axes, or x,y,z, "
            "about the axes of the ground truth's body")
        ->capture_default_str()
        ->group("Protocol");
    command.add_option("--offset", nees.offset, "Add this to the estimate's stamps [s]")
        ->check(isFinite())
        ->capture_default_str()
        ->group("Protocol");
    command
        .add_flag(
            "--nearest",
            nearest,
            "Take ground truth at the nearest stamp instead of interpolating it")
        ->group("Protocol");
}

NeesOptions NeesCommandOptions::resolved() const
{
    if (minNees >= 0 && maxNees >= 0 && minNees > maxNees)
    {
        throw std::invalid_argument(
            "--min-nees " + numberText(minNees) + " is above --max-nees " + numberText(maxNees) +
            ": no NEES is in that range");
    }
    NeesOptions out = nees;
    out.truthSigmaRotation = sigmaFromOption(sigmaRotationDeg);
    out.truthAt = nearest ? TruthAt::NearestStamp : TruthAt::Interpolated;
    return out;
}

std::vector<NeesInterval> NeesCommandOptions::resolvedIntervals() const
{
    std::vector<NeesInterval> out;
    for (const std::string& text : intervals)
    {
        const NeesInterval interval = neesIntervalFromName(text);
        const std::string name = nameOf(interval);
        if (std::any_of(
                out.begin(),
                out.end(),
                [&](const NeesInterval& other) { return nameOf(other) == name; }))
        {
            throw std::invalid_argument("--interval: " + name + " is given more than once");
        }
        out.push_back(interval);
    }
    return out;
}

void NeesCommandOptions::checkRange(
    const std::vector<NeesResult>& results,
    const std::string& untold,
    CommandContext& context) const
{
    if (!untold.empty() && isLimited())
    {
        throw InputError("the stated range of NEES cannot be checked: " + untold);
    }
    for (const NeesResult& result : results)
    {
        const double perDof = result.joint.nees;
        if ((maxNees >= 0 && !(perDof <= maxNees)) ||
            (minNees >= 0 && !(perDof >= minNees)))  // nor NaN
        {
            context.err << context.program << ": NEES per dof " << numberText(perDof, 3) << " at "
                        << nameOf(result.interval) << " is outside the stated range\n";
            context.exitCode = kExitIncomplete;
        }
    }
}
}  // namespace pointplane
