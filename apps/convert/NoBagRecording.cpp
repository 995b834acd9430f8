// SPDX-License-Identifier: BSD-3-Clause
#include "BagRecording.h"

namespace pointplane
{
std::unique_ptr<Recording> openBag(const BagOptions& options)
{
    throw EnvironmentError(
        options.file +
        ": this program was built without ROS 1 bags; install librosbag-storage-dev, "
        "libsensor-msgs-dev and libtf2-msgs-dev and build it again");
}
}  // namespace pointplane
