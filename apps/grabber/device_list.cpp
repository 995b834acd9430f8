// SPDX-License-Identifier: BSD-3-Clause
#include "device_list.h"

#include <pointplane/mrpt_io/errors.h>

#include <ostream>

namespace pointplane
{
namespace
{
void printModes(const char* what, const std::vector<VideoMode>& modes, std::ostream& out)
{
    out << "    " << what << ":";
    for (const auto& mode : modes)
    {
        out << (&mode == &modes.front() ? " " : ", ") << toString(mode);
    }
    out << (modes.empty() ? " none\n" : "\n");
}
}  // namespace

int listCameras(const CameraDrivers& drivers, std::ostream& out, std::ostream& err)
{
    int index = 0;
    for (const auto& driver : drivers)
    {
        for (const auto& device : driver->listDevices())
        {
            out << index++ << "  " << device.uri << "  " << device.vendor << " " << device.name
                << (device.serial.empty() ? "" : "  serial " + device.serial) << "  ("
                << device.driver << ")\n";
            if (!device.problem.empty())
            {
                out << "    cannot be opened: " << device.problem << "\n";
                continue;
            }
            printModes("depth", device.depthModes, out);
            printModes("colour", device.colourModes, out);
            out << "    registration of depth to colour: " << (device.canRegister ? "yes" : "no")
                << "\n";
        }
    }
    if (index == 0)
    {
        err << "pointplane-grabber: " << noCameraHelp(drivers) << "\n";
        return kExitEnvironment;
    }
    return kExitOk;
}
}  // namespace pointplane
