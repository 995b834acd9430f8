// SPDX-License-Identifier: BSD-3-Clause
#include "ConvertApp.h"

#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "ProgressBar.h"
#include "TumConverter.h"
#include "run_program.h"
#include <CLI/CLI.hpp>

namespace pointplane
{
namespace
{
void addTumCommand(CLI::App& app, TumConverterOptions& options)
{
    CLI::App* tum = app.add_subcommand("tum", "A folder of the TUM RGB-D benchmark's layout");
    tum->add_option("folder", options.folder, "holds rgb.txt, depth.txt and the images")
        ->required();
    tum->add_option("-o,--output", options.output, "rawlog to write")->required();
    tum->add_option(
        "--camera",
        options.camera,
        "fr1, fr2, fr3, or a file: MRPT's camera ini or one line `fx fy cx cy k1 k2 p1 p2 k3 width "
        "height unitsPerMetre` (default: camera.txt in the folder, or by the folder's name)");
    tum->add_option(
        "--depth-scale", options.depthScale, "depth units per metre (default: the camera's, 5000)");
    tum->add_option("--max-difference", options.maxDifference, "between colour and depth [s]")
        ->capture_default_str();
    tum->add_option("--label", options.label, "sensor label")->capture_default_str();
    auto* external =
        tum->add_flag("--external", options.external, "images as files beside the rawlog");
    tum->add_flag("--embedded", "images inside the rawlog (default)")->excludes(external);
    tum->add_flag("--quiet", options.quiet, "no progress");
}

int convert(const TumConverterOptions& options, std::ostream& out, std::ostream& err)
{
    const TumConversion done = convertTum(options, err);
    out << options.output << ": " << done.numFrames << " frames\n";
    if (done.numColourAlone + done.numDepthAlone > 0)
    {
        out << "left out, without a partner within " << options.maxDifference
            << " s: " << done.numColourAlone << " colour and " << done.numDepthAlone
            << " depth images\n";
    }
    out << "depth after colour: " << std::round(1e4 * done.depthDelay) / 10 << " ms (median)\n";
    if (!done.groundTruth.empty())
    {
        out << done.groundTruth << ": ground truth\n";
    }
    return kExitOk;
}
}  // namespace

int runConvert(const std::vector<std::string>& args, std::ostream& out, std::ostream& err)
{
    CLI::App app{"Converts RGB-D recordings to MRPT rawlogs, losslessly.", "pointplane-convert"};
    app.set_version_flag("--version", POINTPLANE_VERSION);
    app.require_subcommand(1);
    TumConverterOptions options;
    addTumCommand(app, options);
    return runCommand(app, args, out, err, [&] { return convert(options, out, err); });
}
}  // namespace pointplane
