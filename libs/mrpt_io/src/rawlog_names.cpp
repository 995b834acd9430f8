// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/OutputFile.h>
#include <pointplane/mrpt_io/rawlog_names.h>

#include <filesystem>

namespace pointplane
{
namespace fs = std::filesystem;

std::string imagesFolderOf(const std::string& rawlog)
{
    return fs::path(rawlog).replace_extension().string() + "_Images";
}

std::string partialFolderOf(const std::string& imagesFolder) { return imagesFolder + ".partial"; }

std::string groundTruthOf(const std::string& rawlog)
{
    fs::path name(rawlog);
    if (name.extension() == ".gz")
    {
        name.replace_extension();
    }
    return name.replace_extension().string() + ".groundtruth.txt";
}

bool hasPlaceBeside(const std::string& rawlog) { return outputTarget(rawlog).isReplaced; }
}  // namespace pointplane
