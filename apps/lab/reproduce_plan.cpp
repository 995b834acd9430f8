// SPDX-License-Identifier: BSD-3-Clause
#include "reproduce_plan.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
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

/** What [P17, Table 1 and Table 2] compare. */
void addTables(std::vector<Variant>& plan, const std::string& paper)
{
    plan.push_back({"tables", "points and planes", paper, {}});
    plan.push_back({"tables", "points", paper, kPointsOnly});
    plan.push_back({"tables", "points, unweighted", paper, with(kPointsOnly, kUnweighted)});
}

/** The paper names Tukey's function, not its constant. */
void addTukey(std::vector<Variant>& plan, const std::string& paper)
{
    for (const std::string sigmas : {"0", "3", "4.685"})
    {
        const auto points = with(kPointsOnly, "PoseSolver.tukeySigmas=" + sigmas);
        plan.push_back({"tukey", "points, " + sigmas, paper, points});
        plan.push_back(
            {"tukey", "points, unweighted, " + sigmas, paper, with(points, kUnweighted)});
    }
}

void addAblations(std::vector<Variant>& plan, const std::string& paper)
{
    plan.push_back({"paper", "planes", paper, kPlanesOnly});
    plan.push_back({"paper", "points and planes, unweighted", paper, {kUnweighted}});
    for (const std::string detector : kDetectors)
    {
        plan.push_back(
            {"detectors",
             "points and planes, " + detector,
             paper,
             {"PointDetector.detector=" + detector}});
    }
}

/** First and last stamp of rgb.txt. */
void readStamps(ReproducedSequence& sequence)
{
    std::ifstream list(sequence.folder + "/rgb.txt");
    for (std::string line; std::getline(list, line);)
    {
        if (!line.empty() && line[0] != '#')
        {
            sequence.lastStamp = line.substr(0, line.find_first_of(" \t"));
            sequence.firstStamp =
                sequence.numFrames == 0 ? sequence.lastStamp : sequence.firstStamp;
            ++sequence.numFrames;
        }
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
        const auto path = std::filesystem::path(directory).lexically_normal();
        const auto folder = path.has_filename() ? path : path.parent_path();  // a/ or a
        folders.push_back(folder == "." ? std::filesystem::current_path() : folder);
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
        sequence.name = sequenceName(folder.filename().string(), sequence.isPart);
        readStamps(sequence);
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

std::string chosenOn(const std::string& sequence)
{
    if (sequence == "fr1/xyz")
    {
        return "limits of one plane, the millimetre, SURF's threshold, the circle's radius";
    }
    if (sequence == "fr3/structure_notexture_far")
    {
        return "limits of one plane, the millimetre";
    }
    return sequence == "icl_living_room_kt0" ? "limits of one plane" : "nothing";
}

std::vector<Variant> planVariants(const std::string& paper, const std::vector<std::string>& alphas)
{
    std::vector<Variant> plan;
    addTables(plan, paper);
    addTukey(plan, paper);
    for (const std::string& alpha : alphas)  // [P17, Fig. 3]
    {
        plan.push_back({"alpha", alpha, paper, {"PoseSolver.alpha=" + alpha}});
    }
    plan.push_back({"corner", "planes", paper, kPlanesOnly});  // [P17, Fig. 5]
    plan.push_back({"corner", "points and planes", paper, {}});
    addAblations(plan, paper);
    return plan;
}
}  // namespace pointplane
