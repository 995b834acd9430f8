// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/OutputFile.h>
#include <pointplane/mrpt_io/rawlog_names.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <vector>

namespace pointplane
{
namespace fs = std::filesystem;

namespace
{
/** Those beside a rawlog that are there, best first. MRPT's own CRawlog::detectImagesDirectory()
 * (2.5.8) drops the slash between folder and name, and finds nothing for a path with a folder. */
[[nodiscard]] std::optional<std::string> imagesBeside(const fs::path& rawlog)
{
    std::vector<std::string> names;
    if (rawlog.extension() == ".partial")  // of a run that was killed, its images as well
    {
        const std::string folder = imagesFolderOf(fs::path(rawlog).replace_extension());
        names = {partialFolderOf(folder), folder};
    }
    else
    {
        const std::string stem = fs::path(rawlog).replace_extension().string();
        names = {
            stem + "_Images",
            stem + "_images",
            stem + "_IMAGES",
            (rawlog.parent_path() / "Images").string()};
    }
    const auto isFolder = [](const std::string& name)
    {
        std::error_code error;
        return fs::is_directory(name, error);
    };
    const auto found = std::find_if(names.begin(), names.end(), isFolder);
    return found == names.end() ? std::nullopt : std::optional<std::string>(*found);
}
}  // namespace

std::string imagesFolderOf(const std::string& rawlog)
{
    return fs::path(rawlog).replace_extension().string() + "_Images";
}

std::string imagesFolderToRead(const std::string& rawlog)
{
    std::error_code error;
    const fs::path path(rawlog);
    auto found = imagesBeside(path);
    if (!found && fs::is_symlink(path, error))
    {
        found = imagesBeside(fs::weakly_canonical(path, error));
    }
    const bool isPartial = path.extension() == ".partial";
    return found.value_or(imagesFolderOf(isPartial ? fs::path(path).replace_extension() : path));
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
