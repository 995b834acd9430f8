// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/params_ini.h>
#include <pointplane/odometry/Odometry.h>

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
        return {outcomeOf(result.status), result.increment.mean, result.pose};
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
    return {
        ourMethod("config.ini", standard, {}),
        ourMethod("shutter not told", standard, {}, true),
        ourMethod("points alone", standard, {"Pipeline.usePlanes=false"}),
        ourMethod("planes alone", standard, {"Pipeline.usePoints=false"}),
        ourMethod("frame to frame", standard, {"Reference.reference=previous"}),
        ourMethod("unweighted", standard, {"PoseSolver.weighting=none"}),
        ourMethod("config-fast.ini", fast, {}),
        ourMethod("config-paper.ini", paper, {}),
        ourMethod("paper, points alone", paper, {"Pipeline.usePlanes=false"}),
        ourMethod("paper, unweighted", paper, {"PoseSolver.weighting=none"})};
}
}  // namespace pointplane
