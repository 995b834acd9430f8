// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/core/choice.h>
#include <pointplane/odometry/OdometryParams.h>

#include <stdexcept>
#include <string>

namespace pointplane
{
bool PipelineParams::fuses() const
{
    return chosen<bool>("degeneracy", degeneracy, {{"fuse", true}, {"gate", false}});
}

bool PipelineParams::searchesAhead() const
{
    return chosen<bool>("searchAround", searchAround, {{"prediction", true}, {"previous", false}});
}

void PipelineParams::check() const
{
    POINTPLANE_CHECK(usePoints || usePlanes, "usePoints and usePlanes are both off");
    (void)fuses();
    (void)searchesAhead();
    POINTPLANE_CHECK(gateSigma > 0, "gateSigma = " << gateSigma << " is not positive");
    POINTPLANE_CHECK(maxPointChi2 > 0, "maxPointChi2 = " << maxPointChi2 << " is not positive");
    POINTPLANE_CHECK(
        leastAgreement >= 0 && leastAgreement < 1,
        "leastAgreement = " << leastAgreement << " is not in [0, 1)");
    POINTPLANE_CHECK(maxGap > 0, "maxGap = " << maxGap << " is not positive");
    POINTPLANE_CHECK(
        numThreads == 1 || numThreads == 2, "numThreads = " << numThreads << " is not 1 or 2");
}

void OdometryParams::check() const
{
    OdometryParams copy = *this;  // visiting wants mutable members
    copy.visitSections(
        [](const char* section, const auto& group)
        {
            try
            {
                group.check();
            }
            catch (const std::invalid_argument& error)
            {
                throw std::invalid_argument("[" + std::string(section) + "] " + error.what());
            }
        });
}
}  // namespace pointplane
