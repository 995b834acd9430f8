// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/params_ini.h>
#include <pointplane/odometry/Odometry.h>

#include "methods.h"

namespace pointplane
{
namespace
{
class OurMethod : public Method
{
 public:
    explicit OurMethod(const OdometryParams& params) : odometry_(params) {}
    MethodStep process(const RgbdFrame& frame) override
    {
        const OdometryResult result = odometry_.process(frame);
        MethodStep out;
        out.outcome = result.status == TrackingStatus::Lost        ? Outcome::Lost
                      : result.status == TrackingStatus::Predicted ? Outcome::Predicted
                                                                   : Outcome::Measured;
        out.T_prev_cur = result.increment.mean;
        out.pose = result.pose;
        return out;
    }

 private:
    Odometry odometry_;
};
}  // namespace

std::vector<NamedMethod> ourMethods(const std::string& configDirectory)
{
    struct Variant
    {
        const char *name, *file;
        std::vector<std::string> settings;
    };
    const std::vector<Variant> variants{
        {"config.ini", "config.ini", {}},
        {"points only", "config.ini", {"Pipeline.usePlanes=0"}},
        {"planes only", "config.ini", {"Pipeline.usePoints=0"}},
        {"frame to frame", "config.ini", {"Reference.reference=previous"}},
        {"no self-calibration", "config.ini", {"Shutter.selfCalibrate=0"}},
        {"config-paper.ini", "config-paper.ini", {}},
        {"paper, points only", "config-paper.ini", {"Pipeline.usePlanes=0"}},
        {"paper, points only unweighted",
         "config-paper.ini",
         {"Pipeline.usePlanes=0", "PoseSolver.weighting=none"}}};
    std::vector<NamedMethod> out;
    for (const Variant& v : variants)
    {
        const auto params = loadOdometryParams(configDirectory + "/" + v.file, v.settings);
        out.push_back({v.name, [params] { return std::make_unique<OurMethod>(params); }});
    }
    return out;
}
}  // namespace pointplane
