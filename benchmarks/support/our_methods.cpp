// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/params_ini.h>
#include <pointplane/odometry/Odometry.h>

#include <tuple>

#include "methods.h"

namespace pointplane
{
namespace
{
[[nodiscard]] Outcome outcomeOf(TrackingStatus status)
{
    switch (status)
    {
        case TrackingStatus::Lost:
            return Outcome::Lost;
        case TrackingStatus::Predicted:
            return Outcome::Predicted;
        default:
            return Outcome::Measured;
    }
}

class OurMethod : public Method
{
 public:
    OurMethod(const OdometryParams& params, bool hideShutter)
        : odometry_(params), hideShutter_(hideShutter)
    {
    }
    MethodStep process(const RgbdFrame& frame) override
    {
        RgbdFrame seen = frame;
        if (hideShutter_)
        {
            seen.shutter = {};
        }
        const OdometryResult result = odometry_.process(seen);
        return {
            outcomeOf(result.status),
            result.increment.mean,
            result.increment.cov,
            result.pose,
            result.since};
    }

 private:
    Odometry odometry_;
    bool hideShutter_;
};
}  // namespace

NamedMethod ourMethod(
    const std::string& name,
    const std::string& configFile,
    const std::vector<std::string>& settings,
    bool hideShutter)
{
    const OdometryParams params = loadOdometryParams(configFile, settings);
    return {name, false, [params, hideShutter] {
                return std::make_unique<OurMethod>(params, hideShutter);
            }};
}

std::vector<NamedMethod> ourMethods(const std::string& configDirectory)
{
    const std::string standard = configDirectory + "/config.ini";
    const std::string fast = configDirectory + "/config-fast.ini";
    const std::string paper = configDirectory + "/config-paper.ini";
    const std::vector<std::tuple<std::string, std::string, std::vector<std::string>>> variants{
        {"config.ini", standard, {}},
        {"shutter not told", standard, {}},
        {"points alone", standard, {"Pipeline.usePlanes=false"}},
        {"planes alone", standard, {"Pipeline.usePoints=false"}},
        {"frame to frame", standard, {"Reference.reference=previous"}},
        {"unweighted", standard, {"PoseSolver.weighting=none"}},
        {"config-fast.ini", fast, {}},
        {"config-paper.ini", paper, {}}};
    std::vector<NamedMethod> out;
    for (auto [name, file, settings] : variants)
    {
        settings.emplace_back("Covariance.history=31");  // a second and a dropped frame, for NEES
        out.push_back(ourMethod(name, file, settings, name == "shutter not told"));
    }
    return out;
}
}  // namespace pointplane
