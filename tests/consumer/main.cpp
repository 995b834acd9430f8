#include <pointplane/mrpt_io/RawlogReader.h>
#include <pointplane/mrpt_io/VisualOdometry.h>

#include <mrpt/obs/CObservationComment.h>

#include <iostream>

int main(int, char** argv)
{
    pointplane::VisualOdometry vo;
    vo.loadFromConfigFileName(argv[1]);
    pointplane::RawlogReader rawlog(argv[2]);
    vo.converter().setExternalsDirectory(rawlog.externalsDirectory());
    while (const auto object = rawlog.next())
    {
        if (auto comment = std::dynamic_pointer_cast<mrpt::obs::CObservationComment>(object))
        {
            vo.converter().readComment(*comment);
        }
        if (auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(object))
        {
            const auto result = vo.process(*scan);
            std::cout << toString(result.status) << " " << result.pose.mean << " sigma x "
                      << std::sqrt(result.pose.cov(0, 0)) << " m\n";
        }
    }
    std::cerr << rawlog.ending().message;
    return rawlog.ending().kind == pointplane::RawlogEnd::Clean ? 0 : 1;
}
