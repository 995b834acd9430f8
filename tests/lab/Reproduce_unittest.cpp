// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/ScanWriter.h>
#include <pointplane/mrpt_io/mrpt_poses.h>
#include <pointplane/simulation/SimulatedSequence.h>

#include <Eigen/Geometry>
#include <opencv2/imgcodecs.hpp>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "LabApp.h"
#include "TempDir.h"
#include "run_app.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace pointplane
{
namespace
{
using testing::HasSubstr;

/** A folder in the format of the TUM benchmark: images of a simulated desk at 10 Hz for 1.5 s. */
void writeTumFolder(const std::string& folder)
{
    SimulationParams params;
    params.width = 320;
    params.height = 240;
    params.fps = 10;
    params.duration = 1.5;
    params.motionScale = 0.3;  // as little from frame to frame as at 30 Hz
    const SimulatedSequence sequence("desk", params, 1);
    for (const char* sub : {"rgb", "depth"})
    {
        std::filesystem::create_directories(folder + "/" + sub);
    }
    std::ofstream rgb(folder + "/rgb.txt"), depth(folder + "/depth.txt");
    std::ofstream truth(folder + "/groundtruth.txt");
    truth.precision(9);
    for (int i = 0; i < sequence.numFrames(); ++i)
    {
        cv::Mat colour;
        const RgbdFrame frame = sequence.frame(i, &colour);
        const std::string stamp = stampText(fromSeconds(frame.stamp));
        const std::string name = std::to_string(i) + ".png";
        ASSERT_TRUE(cv::imwrite(folder + "/rgb/" + name, colour));
        ASSERT_TRUE(cv::imwrite(folder + "/depth/" + name, depthInUnits(frame.depth, 5000)));
        rgb << stamp << " rgb/" << name << "\n";
        depth << stamp << " depth/" << name << "\n";
        const Eigen::Isometry3d T = sequence.truth(frame.stamp);
        const Eigen::Quaterniond q(T.linear());
        truth << stamp << ' ' << T.translation().transpose() << ' ' << q.coeffs().transpose()
              << "\n";
    }
    const PinholeCamera camera = sequence.frame(0).camera;
    std::ofstream(folder + "/camera.txt")
        << camera.fx << ' ' << camera.fy << ' ' << camera.cx << ' ' << camera.cy << " 0 0 0 0 0 "
        << camera.width << ' ' << camera.height << " 5000\n";
}

/** The command with the real programs. */
test::AppRun reproduce(const std::string& folder, const std::vector<std::string>& options)
{
    std::vector<std::string> args{
        "reproduce",
        folder,
        "--paper-config",
        POINTPLANE_SOURCE_DIR "/config-paper.ini",
        "--odometry",
        POINTPLANE_ODOMETRY,
        "--convert",
        POINTPLANE_CONVERT,
        "--simulate",
        POINTPLANE_SIMULATE,
        "--corner-duration",
        "1.2"};
    args.insert(args.end(), options.begin(), options.end());
    return test::runApp(runLab, args);
}
}  // namespace

/** Both would be worked on in one file. */
TEST(Reproduce, foldersOfOneNameAreRefused)
{
    const test::TempDir dir;
    writeTumFolder(dir / "a/seq");
    writeTumFolder(dir / "b/seq");
    for (const std::string& other : {dir / "b/seq", dir / "b/seq/", dir / "a/seq"})
    {
        const test::AppRun r = reproduce(dir / "a/seq", {other});
        EXPECT_EQ(r.code, 2);
        EXPECT_THAT(r.err, HasSubstr("have the same name; give each folder once"));
    }
}

/** From images to tables. */
TEST(Reproduce, fromATumFolderToTheTables)
{
    const test::TempDir dir;
    writeTumFolder(dir / "sequences/rgbd_dataset_freiburg1_desk");
    const test::AppRun r = reproduce(
        dir / "sequences",
        {"--alphas",
         "0,10",
         "--json",
         dir / "out.json",
         "--report",
         dir / "report",
         "--figure",
         dir / "figures"});
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_THAT(r.out, HasSubstr("Table 1"));
    EXPECT_THAT(r.out, HasSubstr("| 43 / 2.3 "));
    EXPECT_THAT(r.out, HasSubstr("| fr1/360 "));
    EXPECT_THAT(test::readBytes(dir / "report/index.html"), HasSubstr("Fig. 3: Translation"));
    EXPECT_THAT(r.out, HasSubstr("Fig. 5"));
    EXPECT_THAT(r.out, HasSubstr("| 16            | 16     | yes          | nothing "));
    for (const char* const figure :
         {"fig3_translation",
          "fig3_rotation",
          "fig5_planes_translation",
          "fig5_planes_rotation",
          "fig5_points_and_planes_translation",
          "fig5_points_and_planes_rotation"})
    {
        EXPECT_THAT(
            test::readBytes(dir / (std::string("figures/paper_") + figure + ".svg")),
            HasSubstr("</svg>"))
            << figure;
    }
    // 18 of the sequence and two of the corner; four repeat others (Tukey's usual constant, alpha
    // 10, SURF).
    EXPECT_THAT(r.err, HasSubstr("[16/16, 0 s left]"));

    const auto json = nlohmann::json::parse(test::readBytes(dir / "out.json"));
    ASSERT_EQ(json["runs"].size(), 18U);
    ASSERT_EQ(json["corner"].size(), 2U);
    EXPECT_EQ(json["corner"][0]["settings"], std::vector<std::string>{"Pipeline.usePoints=false"});
    EXPECT_TRUE(json["corner"][1]["settings"].empty());
    for (const auto& run : json["corner"])
    {
        EXPECT_GT(run["finalError"], 0) << run;
        EXPECT_LT(run["finalError"], 0.05) << run;
    }
    EXPECT_EQ(json["published"].size(), 4U);
    double paperOwn = 0;
    for (const auto& run : json["runs"])
    {
        const std::string name =
            run["group"].get<std::string>() + ", " + run["variant"].get<std::string>();
        ASSERT_TRUE(run.contains("translation")) << name << ": " << run;
        EXPECT_EQ(run["pairs"], 5U) << name;  // of 16 poses
        if (name == "tables, points and planes")
        {
            paperOwn = run["translation"];
            EXPECT_LT(paperOwn, 0.05);
        }
        if (name == "alpha, 10" || name == "detectors, points and planes, surf")
        {
            EXPECT_EQ(run["translation"], paperOwn) << name;
        }
    }
}

TEST(Reproduce, onlyTheTables)
{
    const test::TempDir dir;
    writeTumFolder(dir / "mine");
    const test::AppRun r = reproduce(dir / "mine", {"--only", "tables"});
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_THAT(r.err, HasSubstr("[3/3, 0 s left]"));
    EXPECT_THAT(r.out, HasSubstr("Table 2"));
    EXPECT_THAT(r.out, testing::Not(HasSubstr("Ablations")));
    EXPECT_THAT(r.out, testing::Not(HasSubstr("alpha")));
}
}  // namespace pointplane
