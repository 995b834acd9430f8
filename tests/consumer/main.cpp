// Prints the pose of each frame of a rawlog: consumer CONFIG.ini IN.rawlog
#include <pointplane/mrpt_io/RawlogReader.h>
#include <pointplane/mrpt_io/VisualOdometry.h>

#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <cmath>
#include <iostream>

namespace
{
void use(mrpt::obs::CObservation& observation, pointplane::VisualOdometry& vo)
{
    if (const auto* comment = dynamic_cast<mrpt::obs::CObservationComment*>(&observation))
    {
        vo.converter().readComment(*comment);  // shutter and intrinsics
    }
    if (const auto* scan = dynamic_cast<mrpt::obs::CObservation3DRangeScan*>(&observation))
    {
        const auto result = vo.process(*scan);
        std::cout << toString(result.status) << " " << result.pose.mean << " sigma x "
                  << std::sqrt(result.pose.cov(0, 0)) << " m\n";
    }
}

/** \return whether all of the rawlog was read */
bool run(const std::string& config, const std::string& path)
{
    pointplane::VisualOdometry vo;
    vo.loadFromConfigFileName(config);
    pointplane::RawlogReader rawlog(path);
    vo.converter().setExternalsDirectory(rawlog.externalsDirectory());
    while (const auto object = rawlog.next())
    {
        // Rawlogs hold observations (format 2), or sensory frames of them (format 1).
        if (const auto observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object))
        {
            use(*observation, vo);
        }
        if (const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object))
        {
            for (const auto& observation : *frame)
            {
                use(*observation, vo);
            }
        }
    }
    const bool isWhole = rawlog.ending().kind == pointplane::RawlogEnd::Clean;
    std::cerr << rawlog.ending().message << (isWhole ? "" : "\n");
    return isWhole;
}
}  // namespace

int main(int argc, char** argv)
{
    if (argc != 3)
    {
        std::cerr << "usage: " << argv[0] << " CONFIG.ini IN.rawlog\n";
        return 2;
    }
    try
    {
        return run(argv[1], argv[2]) ? 0 : 1;
    }
    catch (const std::exception& e)  // of pointplane: one line that says what is wrong
    {
        std::cerr << argv[0] << ": " << e.what() << "\n";
        return 2;
    }
}
