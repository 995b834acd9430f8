// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/core/choice.h>
#include <pointplane/core/range.h>
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
    checkRange("gateSigma", gateSigma, 1e-6, 2);
    checkRange("leastAgreement", leastAgreement, 0, 0.99);
    checkRange("maxGap", maxGap, 0.001, 3600);
    checkRange("numThreads", numThreads, 1, 2);
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
