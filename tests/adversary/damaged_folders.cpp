// SPDX-License-Identifier: BSD-3-Clause
#include <opencv2/imgcodecs.hpp>

#include "Attempt.h"
#include "ConvertApp.h"
#include "TempDir.h"

namespace pointplane::adversary
{
namespace
{
namespace fs = std::filesystem;
constexpr int kAttempts = 600;

void damage(const std::string& path, std::mt19937& rng)
{
    std::string bytes = test::readBytes(path);
    const std::size_t at = rng() % bytes.size();
    switch (rng() % 7)
    {
        case 0:
            fs::remove(path);
            return;
        case 1:
            fs::remove(path);
            fs::create_directory(path);
            return;
        case 2:
            test::writeBytes(path, bytes.substr(0, at));
            return;
        case 3:
            bytes[at] = static_cast<char>(bytes[at] ^ (1 << (rng() % 8)));
            break;
        case 4:
            bytes.replace(at, std::min<std::size_t>(8, bytes.size() - at), 8, '\0');
            break;
        case 5:
            bytes.insert(at, "nan -1e999 \n");
            break;
        default:
            bytes = "";
            break;
    }
    test::writeBytes(path, bytes);
}
}  // namespace

void writeTumFolder(const std::string& folder)
{
    fs::create_directories(folder + "/rgb");
    fs::create_directories(folder + "/depth");
    cv::Mat colour(24, 32, CV_8UC3), depth(24, 32, CV_16UC1);
    std::string rgb = "# colour\n", depths = "# depth\n", truth;
    for (int i = 0; i < kTumFrames; ++i)
    {
        cv::randu(colour, 0, 256);
        cv::randu(depth, 4000, 6000);
        const std::string name = std::to_string(i) + ".png";
        cv::imwrite(folder + "/rgb/" + name, colour);
        cv::imwrite(folder + "/depth/" + name, depth);
        const std::string stamp =
            std::to_string(1305031102 + i / 4) + "." + std::to_string(25 * (i % 4));
        rgb += stamp + " rgb/" + name + "\n";
        depths += stamp + " depth/" + name + "\n";
        truth += stamp + " 0 0 0 0 0 0 1\n";
    }
    test::writeBytes(folder + "/rgb.txt", rgb);
    test::writeBytes(folder + "/depth.txt", depths);
    test::writeBytes(folder + "/camera.txt", "26.2 26.1 15.5 11.5 0 0 0 0 0 32 24 5000\n");
    test::writeBytes(folder + "/groundtruth.txt", truth);
}

Tally damagedFolders(double share)
{
    Tally tally("damaged folders of `pointplane-convert tum`: files cut, garbled, gone, exchanged");
    const test::TempDir dir;
    std::mt19937 rng(22);
    const std::string whole = dir / "whole", folder = dir / "folder";
    writeTumFolder(whole);
    std::vector<std::string> names{"rgb.txt", "depth.txt", "camera.txt", "groundtruth.txt"};
    for (int i = 0; i < kTumFrames; ++i)
    {
        names.push_back("rgb/" + std::to_string(i) + ".png");
        names.push_back("depth/" + std::to_string(i) + ".png");
    }
    for (int i = 0; i < kAttempts * share; ++i)
    {
        fs::remove_all(folder);
        fs::copy(whole, folder, fs::copy_options::recursive);
        const std::string name = names[rng() % names.size()];
        damage(folder + "/" + name, rng);
        const std::string out = dir / "out.rawlog";
        test::writeBytes(out, "old");
        const Attempt a = attempt(runConvert, {"tum", folder, "-o", out, "--quiet"});
        std::string wrong = wrongWith(a) + unless(a.code >= 0 && a.code <= 2, "exit code");
        wrong += unless(
            a.code == 0 || a.err.find(folder) != std::string::npos, "no file named: " + a.err);
        wrong += unless((a.code < 2) == (test::readBytes(out) != "old"), "earlier output");
        wrong += unless(!fs::exists(out + ".partial"), "partial file");
        tally.add(a, wrong, name + ", number " + std::to_string(i));
    }
    return tally;
}
}  // namespace pointplane::adversary
