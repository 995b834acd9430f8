// SPDX-License-Identifier: BSD-3-Clause
#include "reproduce_plan.h"

#include <algorithm>
#include <filesystem>
#include <regex>

namespace pointplane
{
namespace
{
const std::vector<std::string> kPointsOnly{"Pipeline.usePlanes=false"};
const std::vector<std::string> kPlanesOnly{"Pipeline.usePoints=false"};
constexpr const char* kUnweighted = "PoseSolver.weighting=none";
constexpr const char* kDetectors[] = {"surf", "orb", "akaze", "sift", "fast"};

bool isSequence(const std::filesystem::path& folder)
{
    return std::filesystem::exists(folder / "rgb.txt") &&
           std::filesystem::exists(folder / "depth.txt") &&
           std::filesystem::exists(folder / "groundtruth.txt");
}

std::vector<std::string> with(std::vector<std::string> settings, const std::string& more)
{
    settings.push_back(more);
    return settings;
}

/** What Tables 1 and 2 compare. */
void addTableRows(std::vector<Variant>& plan, const std::string& group, const std::string& config)
{
    plan.push_back({group, "points and planes", config, {}});
    plan.push_back({group, "points", config, kPointsOnly});
    plan.push_back({group, "points, unweighted", config, with(kPointsOnly, kUnweighted)});
}

/** The other features, weights and detectors, one changed at a time. */
void addAblations(std::vector<Variant>& plan, const std::string& group, const std::string& config)
{
    plan.push_back({group, "planes", config, kPlanesOnly});
    plan.push_back({group, "points and planes, unweighted", config, {kUnweighted}});
    for (const std::string detector : kDetectors)
    {
        plan.push_back(
            {group,
             "points and planes, " + detector,
             config,
             {"Points.method=match", "PointDetector.detector=" + detector}});
    }
}
}  // namespace

std::string sequenceName(const std::string& folderName, bool& isPart)
{
    static const std::regex kPattern("(?:.*_)?(?:fr|freiburg)([123])_(.*?)(_part)?");
    std::smatch match;
    if (!std::regex_match(folderName, match, kPattern))
    {
        isPart = folderName.size() > 5 && folderName.substr(folderName.size() - 5) == "_part";
        return isPart ? folderName.substr(0, folderName.size() - 5) : folderName;
    }
    isPart = match[3].matched;
    return "fr" + match[1].str() + "/" + match[2].str();
}

std::vector<ReproducedSequence> findSequences(const std::string& directory)
{
    std::vector<std::filesystem::path> folders;
    if (isSequence(directory))
    {
        folders.push_back(std::filesystem::path(directory).lexically_normal());
    }
    else if (std::filesystem::is_directory(directory))
    {
        for (const auto& entry : std::filesystem::directory_iterator(directory))
        {
            if (entry.is_directory() && isSequence(entry.path()))
            {
                folders.push_back(entry.path());
            }
        }
    }
    std::sort(folders.begin(), folders.end());
    std::vector<ReproducedSequence> out;
    for (const std::filesystem::path& folder : folders)
    {
        ReproducedSequence sequence;
        sequence.folder = folder.string();
        const auto last = folder.has_filename() ? folder : folder.parent_path();
        sequence.name = sequenceName(last.filename().string(), sequence.isPart);
        out.push_back(std::move(sequence));
    }
    return out;
}

const std::vector<PublishedFigures>& publishedFigures()
{
    static const std::vector<PublishedFigures> figures{
        {"fr1/desk", "43 / 2.3", "38 / 2.2", "37 / 2.1", "26 (Gutierrez-Gomez 2016)"},
        {"fr1/360", "109 / 3.7", "86 / 3.5", "73 / 2.9", "84 (PLVO)"},
        {"fr3/structure_notexture_far", "", "fail", "50 / 1.5", "43 (Yang 2017)"},
        {"fr3/cabinet", "", "fail", "80 / 4.0", "133 (Yang 2017)"}};
    return figures;
}

std::vector<Variant> planVariants(
    const std::string& paperConfig,
    const std::string& defaultConfig,
    const std::vector<std::string>& alphas)
{
    std::vector<Variant> plan;
    addTableRows(plan, "tables", paperConfig);
    addAblations(plan, "paper", paperConfig);
    addTableRows(plan, "default", defaultConfig);
    addAblations(plan, "default", defaultConfig);
    for (const std::string& alpha : alphas)
    {
        plan.push_back({"alpha", alpha, paperConfig, {"PoseSolver.alpha=" + alpha}});
    }
    return plan;
}
}  // namespace pointplane
