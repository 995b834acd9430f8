// SPDX-License-Identifier: BSD-3-Clause
#include "EvalApp.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iomanip>
#include <sstream>
#include <utility>

#include "nees_output.h"
#include "result_output.h"
#include "run_app.h"
#include "test_trajectories.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

using namespace pointplane;
using testing::HasSubstr;

namespace
{
test::AppRun run(const std::vector<std::string>& args) { return test::runApp(runEval, args); }

/** Straight motion at 10 Hz, `factor` times as fast as 1 m/s. */
std::string straightLine(double factor, double later = 0)
{
    std::ostringstream out;
    out << std::setprecision(15);
    for (int i = 0; i <= 50; ++i)
    {
        out << 0.1 * i + later << " " << 0.1 * i * factor << " 0 0 0 0 0 1\n";
    }
    return out.str();
}

class EvalApp : public testing::Test
{
 protected:
    test::TempDir files;
    std::string truth = writeFile(files, "truth.txt", straightLine(1));
    std::string estimate = writeFile(files, "estimate.txt", straightLine(1.05));
};
}  // namespace

TEST_F(EvalApp, rpeTableAndBothSpellings)
{
    const test::AppRun hyphens =
        run({"rpe", truth, estimate, "--fixed-delta", "--delta-unit", "s"});
    EXPECT_EQ(hyphens.code, 0) << hyphens.err;
    EXPECT_THAT(hyphens.out, HasSubstr("fixed delta 1 s"));
    EXPECT_THAT(hyphens.out, HasSubstr("translation [m]      0.050000"));
    const test::AppRun underscores =
        run({"rpe", truth, estimate, "--fixed_delta", "--delta_unit=s"});
    EXPECT_EQ(underscores.out, hyphens.out);
}

TEST_F(EvalApp, aRangeOfNeesThatIsEmptyIsRefused)
{
    const test::AppRun r = run({"nees", truth, estimate, "--min-nees", "2", "--max-nees", "0.5"});
    EXPECT_EQ(r.code, 2);
    EXPECT_EQ(
        r.err, "pointplane-eval: --min-nees 2 is above --max-nees 0.5: no NEES is in that range\n");
}

TEST_F(EvalApp, stampsInMillisecondsAreTold)
{
    std::ostringstream inMilliseconds;
    for (int i = 0; i <= 50; ++i)
    {
        inMilliseconds << 15000000 + i << "00000 0 0 0 0 0 0 1\n";
    }
    const std::string seconds = writeFile(files, "s.txt", straightLine(1, 1.5e9));
    const std::string fine = writeFile(files, "ms.txt", inMilliseconds.str());
    for (const auto& [first, second] : {std::pair(seconds, fine), std::pair(fine, seconds)})
    {
        const test::AppRun r = run({"rpe", first, second});
        EXPECT_EQ(r.code, 2);
        EXPECT_THAT(
            r.err,
            HasSubstr(
                "; stamps of '" + fine + "' look like milliseconds: write them in seconds\n"));
    }
    EXPECT_THAT(
        run({"rpe", seconds, estimate}).err, HasSubstr("are these files of the same sequence?"));
}

namespace
{
/** A winding path as TUM text; `perMetre` is its unit of length, `wFirst` the order of its
 * quaternions, and `faster` a small error. */
std::string winding(double perMetre, bool wFirst, double faster = 1)
{
    std::ostringstream out;
    out << std::setprecision(15);
    for (int i = 0; i <= 60; ++i)
    {
        const double t = 0.1 * i;
        const Eigen::Quaterniond q(
            Eigen::AngleAxisd(0.3 * faster * t, Eigen::Vector3d::UnitY()) *
            Eigen::AngleAxisd(std::sin(t), Eigen::Vector3d::UnitX()));
        out << t << " " << perMetre * t * faster << " " << perMetre * std::cos(t) << " 0 ";
        if (wFirst)
        {
            out << q.w() << " " << q.x() << " " << q.y() << " " << q.z() << "\n";
        }
        else
        {
            out << q.x() << " " << q.y() << " " << q.z() << " " << q.w() << "\n";
        }
    }
    return out.str();
}
}  // namespace

/** Else they give a score that looks like that of an odometry that fails. */
TEST_F(EvalApp, millimetresAndOtherOrdersOfQuaternionsAreTold)
{
    const std::string good = writeFile(files, "good.txt", winding(1, false));
    const std::string poor = writeFile(files, "poor.txt", winding(1, false, 1.1));
    const std::string fine = writeFile(files, "mm.txt", winding(1000, false, 1.1));
    const std::string wFirst = writeFile(files, "wxyz.txt", winding(1, true, 1.1));
    const std::string unit = "hint: positions of '" + fine + "' look like millimetres: write them ";
    const std::string order =
        "hint: quaternions of '" + wFirst + "' look like qw qx qy qz: write them as qx qy qz qw\n";
    for (const char* command : {"rpe", "ate", "compare"})
    {
        EXPECT_EQ(run({command, good, poor}).err, "");
        EXPECT_EQ(run({command, good, fine, "--scale", "0.001"}).err, "");
        EXPECT_THAT(run({command, good, fine}).err, HasSubstr(unit));
        EXPECT_THAT(run({command, fine, good}).err, HasSubstr(unit));
        EXPECT_THAT(run({command, good, wFirst}).err, HasSubstr(order));
        EXPECT_THAT(run({command, wFirst, good}).err, HasSubstr(order));
    }
    EXPECT_EQ(run({"rpe", truth, writeFile(files, "far.txt", straightLine(100))}).err, "");
}

/** Rotations about one axis are alike if the numbers of the quaternions change places. */
TEST_F(EvalApp, otherAxesAreNotTakenForAnotherOrderOfQuaternions)
{
    const Eigen::Quaterniond axes(0.5, -0.5, 0.5, -0.5);  // of a camera on a robot
    const Eigen::Quaterniond world = Eigen::Quaterniond(-4, 2, 4, -1).normalized();
    std::ostringstream camera, robot;
    const auto write = [](std::ostream& out, double t, const Eigen::Quaterniond& q)
    {
        const Eigen::Vector3d x = q * Eigen::Vector3d(t, std::cos(t), 0);
        out << t << " " << x.x() << " " << x.y() << " " << x.z() << " " << q.x() << " " << q.y()
            << " " << q.z() << " " << q.w() << "\n";
    };
    for (int i = 0; i < 60; ++i)
    {
        const double t = 0.1 * i;
        const Eigen::Quaterniond q(Eigen::AngleAxisd(std::sin(t), Eigen::Vector3d::UnitZ()));
        write(camera, t, world * q * axes);
        write(robot, t, q);
    }
    const std::string a = writeFile(files, "camera.txt", camera.str());
    const std::string b = writeFile(files, "robot.txt", robot.str());
    for (const char* command : {"rpe", "ate"})
    {
        EXPECT_EQ(run({command, a, b}).err, "");
        EXPECT_EQ(run({command, b, a}).err, "");
    }
}

TEST_F(EvalApp, verboseIsTheScriptsOutput)
{
    EXPECT_THAT(
        run({"rpe", truth, estimate, "--fixed_delta", "--verbose"}).out,
        testing::StartsWith("compared_pairs 40 pairs\n"
                            "translational_error.rmse 0.050000 m\n"));
    EXPECT_THAT(
        run({"ate", truth, estimate, "--verbose"}).out,
        testing::StartsWith("compared_pose_pairs 51 pairs\n"
                            "absolute_translational_error.rmse 0.073598 m\n"));
}

TEST_F(EvalApp, aWordThatAnOptionDoesNotKnowIsToldWithThoseItKnows)
{
    for (const std::string word : {"horn", "1", "Se3"})
    {
        const test::AppRun r = run({"ate", truth, estimate, "--align", word});
        EXPECT_EQ(r.code, 2);
        EXPECT_EQ(
            r.err,
            "pointplane-eval: --align: '" + word +
                "' is not one of se3, first, none (see --help)\n");
    }
    EXPECT_THAT(
        run({"rpe", truth, estimate, "--fixed-delta", "--delta-unit", "min"}).err,
        HasSubstr("--delta-unit: 'min' is not one of s, m, rad, deg, f (see"));
    EXPECT_EQ(run({"ate", truth, estimate, "--align", "first"}).code, 0);
}

/** Where files tell whose poses they hold, those of different bodies are never compared in silence.
 */
TEST_F(EvalApp, posesOfDifferentBodiesAreTold)
{
    const std::string ofCamera = writeFile(
        files,
        "camera.txt",
        "# stamp tx ty tz qx qy qz qw; poses of the camera, x right, y down, z forward\n" +
            straightLine(1));
    const std::string ofRobot = writeFile(
        files,
        "robot.txt",
        "# poses of the robot, axes x forward, y left, z up; sensorPose = identity\n" +
            straightLine(1));
    for (const char* command : {"rpe", "ate", "compare"})
    {
        const std::vector<std::string> delta = std::string(command) == "rpe"
                                                   ? std::vector<std::string>{"--fixed-delta"}
                                                   : std::vector<std::string>{};
        const auto errOf = [&](const std::string& a, const std::string& b, const char* body)
        {
            std::vector<std::string> args{command, a, b};
            args.insert(args.end(), delta.begin(), delta.end());
            if (body != nullptr)
            {
                args.insert(args.end(), {"--body-from-gt", body});
            }
            return run(args).err;
        };
        EXPECT_THAT(
            errOf(ofCamera, ofRobot, nullptr),
            testing::AllOf(
                HasSubstr("hint: the poses of '" + ofCamera + "' are of the camera"),
                HasSubstr("those of '" + ofRobot + "' of the robot; give --body-from-gt optical")));
        EXPECT_THAT(
            errOf(ofRobot, ofCamera, nullptr), HasSubstr("give --body-from-gt 0,0,0,0,-90,90 if"));
        for (const std::string& other : {ofRobot, ofCamera, truth})
        {
            const auto saysNothing = testing::Not(HasSubstr("the poses of"));
            EXPECT_THAT(errOf(other, other, nullptr), saysNothing) << command;
            EXPECT_THAT(errOf(truth, other, nullptr), saysNothing) << command;
        }
        EXPECT_EQ(errOf(ofCamera, ofRobot, "optical"), "");
    }
}

TEST_F(EvalApp, gateSetsTheExitCode)
{
    const std::vector<std::string> base{"rpe", truth, estimate, "--fixed-delta"};
    const auto with = [&](const char* option, const char* value)
    {
        std::vector<std::string> args = base;
        args.insert(args.end(), {option, value});
        return run(args);
    };
    EXPECT_EQ(with("--max-rmse", "0.0501").code, 0);
    EXPECT_EQ(with("--max-rmse-deg", "0.1").code, 0);
    EXPECT_EQ(with("--max-rmse", "0.0501").err, "");
    EXPECT_THAT(with("--max-rmse", "50").err, HasSubstr("is 50 m, the translation RMSE 0.05"));
    EXPECT_THAT(with("--max-rmse", "50").err, HasSubstr(": is it in millimetres?\n"));
    const test::AppRun exceeded = with("--max-rmse", "0.0499");
    EXPECT_EQ(exceeded.code, 1);
    EXPECT_THAT(exceeded.err, HasSubstr("translation RMSE 0.050000 m exceeds"));
    EXPECT_EQ(run({"ate", truth, estimate, "--max-rmse", "0.01"}).code, 1);
}

TEST_F(EvalApp, jsonAndCsv)
{
    const test::AppRun json = run({"rpe", truth, estimate, "--fixed-delta", "--json", "-"});
    const auto parsed = nlohmann::json::parse(json.out);
    EXPECT_EQ(parsed["pairs"], 40);
    EXPECT_NEAR(parsed["translation"]["rmse"], 0.05, 1e-9);
    EXPECT_EQ(parsed["translation"]["unit"], "m");

    const std::string csvPath = files / "out.csv";
    EXPECT_EQ(run({"ate", truth, estimate, "--csv", csvPath}).code, 0);
    std::ifstream csv(csvPath);
    std::string header;
    std::string row;
    std::getline(csv, header);
    std::getline(csv, row);
    EXPECT_THAT(header, testing::StartsWith("estimate,ground_truth,protocol,quantity,unit,count"));
    EXPECT_THAT(row, HasSubstr(",translation,m,51,0.0735"));
}

TEST_F(EvalApp, compareMarksTheBest)
{
    const std::string worse = writeFile(files, "worse.txt", straightLine(1.1));
    const test::AppRun r = run(
        {"compare",
         truth,
         worse,
         estimate,
         "--report",
         files / "report",
         "--json",
         files / "out.json"});
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_THAT(r.out, HasSubstr("100.000  +50.000 [+50.000, +50.000]"));
    EXPECT_THAT(r.out, HasSubstr("50.000* best"));
    EXPECT_THAT(r.out, HasSubstr("RPE [deg]"));
    std::istringstream table(r.out.substr(r.out.find("\n\n")));
    for (std::string line; std::getline(table, line);)
    {
        EXPECT_LE(line.size(), 80U) << line;
    }
    const auto json = nlohmann::json::parse(test::readBytes(files / "out.json"));
    EXPECT_EQ(json["bestTranslation"], estimate);
    EXPECT_NEAR(json["runs"][0]["translationBehindBest"]["value"], 0.05, 1e-9);
    EXPECT_THAT(test::readBytes(files / "report/index.html"), HasSubstr("Comparison of 2 runs"));
    EXPECT_EQ(run({"compare", truth}).code, 2);
}

TEST(ShownNames, fillTheirColumnWhateverLettersTheyHave)
{
    EXPECT_THAT(
        shownNames(
            {"e.txt",
             "\u00e9.txt",
             "\u00e9\u00e9\u00e9\u00e9.txt",
             "\u00e9\u00e9\u00e9\u00e9\u00e9.txt"},
            8),
        testing::ElementsAre(
            "e.txt   ", "\u00e9.txt   ", "\u00e9\u00e9\u00e9\u00e9.txt", "...\u00e9.txt"));
}

/** The ends of such names are alike. */
TEST(ShownNames, ofFoldersWithTheSameFilesDiffer)
{
    const std::string ending = "/fr1_xyz/trajectory.txt";
    EXPECT_THAT(
        shownNames({"old" + ending, "runs/new" + ending}, 8),
        testing::ElementsAre("old     ", "runs/new"));
    EXPECT_THAT(
        shownNames({"a/b.txt", "c/b.txt"}, 8), testing::ElementsAre("a/b.txt ", "c/b.txt "));
    EXPECT_THAT(
        shownNames({"/fr1_xyz/a.txt", "/fr1_xyz/a.txt"}, 8),
        testing::ElementsAre("...a.txt", "...a.txt"));
    EXPECT_THAT(shownNames({"fr1_xyz/a.txt"}, 8), testing::ElementsAre("...a.txt"));
}

TEST_F(EvalApp, compareTellsWhatIsTooShortForAnInterval)
{
    const std::string worse = writeFile(files, "worse.txt", straightLine(1.1));
    std::vector<std::string> args{"compare", truth, worse, estimate, "--delta", "2"};
    args.insert(args.end(), {"--json", files / "out.json", "--csv", files / "out.csv"});
    const test::AppRun r = run(args);
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_THAT(r.out, HasSubstr("200.000  +100.000 too short\n"));
    EXPECT_THAT(r.out, HasSubstr("too short for an interval: 1 pair without overlap, at least"));
    const auto behind = nlohmann::json::parse(
        test::readBytes(files / "out.json"))["runs"][0]["translationBehindBest"];
    EXPECT_TRUE(behind["lower95"].is_null());
    EXPECT_EQ(behind["independent"], 1);
    EXPECT_THAT(test::readBytes(files / "out.csv"), testing::ContainsRegex(",0.2,,,0(.0)?,,,"));
}

TEST_F(EvalApp, runsThatCannotBeComparedHaveNoBest)
{
    const std::string shifted = writeFile(files, "shifted.txt", straightLine(1.1, 0.001));
    const test::AppRun r = run({"compare", truth, shifted, estimate, "--json", files / "out.json"});
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_THAT(r.out, HasSubstr("their errors cannot be compared"));
    EXPECT_EQ(r.out.find('*'), std::string::npos) << r.out;
    EXPECT_TRUE(
        nlohmann::json::parse(test::readBytes(files / "out.json"))["bestTranslation"].is_null());
}

/** A hint beside a best run and a significant difference helped nobody, and was not in the report.
 */
TEST_F(EvalApp, posesOfCameraAndRobotHaveNoBest)
{
    const std::string ofCamera =
        writeFile(files, "camera.txt", "# x right, y down, z forward\n" + straightLine(1));
    const std::string ofRobot =
        writeFile(files, "robot.txt", "# x forward, y left, z up\n" + straightLine(1.1));
    const test::AppRun r = run(
        {"compare", truth, ofCamera, ofRobot, "--json", files / "o.json", "--report", files / "r"});
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_THAT(r.out, HasSubstr("others of the robot: their errors cannot be compared\n"));
    EXPECT_EQ(r.out.find('*'), std::string::npos) << r.out;
    const auto json = nlohmann::json::parse(test::readBytes(files / "o.json"));
    EXPECT_TRUE(json["bestTranslation"].is_null());
    EXPECT_TRUE(json["bestAte"].is_null());
    EXPECT_FALSE(json["runs"][1].contains("translationBehindBest"));
    EXPECT_THAT(test::readBytes(files / "r/index.html"), HasSubstr("Hint: the poses of"));
    EXPECT_THAT(run({"compare", truth, ofCamera, truth}).out, HasSubstr("*"));
}

/** Millimetres taken for metres. */
TEST_F(EvalApp, columnsStayApartWhereErrorsAreHuge)
{
    const std::string huge = writeFile(files, "huge.txt", straightLine(1e7));
    EXPECT_THAT(
        run({"ate", truth, huge}).out,
        testing::Not(testing::ContainsRegex("[0-9][.][0-9]{6}[0-9]")));
}

/** Their digits are lost: the error of a run that got stuck out there would be 0. */
TEST_F(EvalApp, positionsBeyondWhatDoubleResolvesAreRefused)
{
    const std::string far = writeFile(files, "far.txt", straightLine(1e17));
    for (const char* command : {"rpe", "ate", "compare"})
    {
        const test::AppRun r = run({command, truth, far});
        EXPECT_EQ(r.code, 2) << command;
        EXPECT_THAT(
            r.err,
            testing::AllOf(
                HasSubstr("far.txt: the position at 0.100000 s is 1e+16 m away"),
                HasSubstr("beyond 1e+08 m")));
        const test::AppRun scaled = run({command, truth, estimate, "--scale", "1e300"});
        EXPECT_EQ(scaled.code, 2) << command;
        EXPECT_THAT(
            scaled.err, HasSubstr("estimate.txt: the position at 0.100000 s times 1.000e+300"));
    }
}

TEST_F(EvalApp, timesOf300DigitsAreInScientificForm)
{
    const test::AppRun r = run({"rpe", truth, estimate, "--offset", "1e300"});
    EXPECT_EQ(r.code, 2);
    EXPECT_THAT(r.err, HasSubstr("[1.000e+300, 1.000e+300] s"));
}

namespace
{
/** As pointplane-odometry writes it: the first `tracked` of 51 frames, the others lost. */
std::string mostlyLost(int tracked)
{
    std::istringstream lines(straightLine(1));
    std::string out = "# pointplane-status: what such lines mean\n";
    int k = 0;
    for (std::string line; std::getline(lines, line); ++k)
    {
        const std::string stamp = line.substr(0, line.find(' '));
        out += k < tracked ? line + "\n" : "# pointplane-status " + stamp + " lost: no depth\n";
    }
    return out;
}
}  // namespace

/** Who loses all but the easy frames would pass best. */
TEST_F(EvalApp, aRunThatLostMostOfItsFramesPassesNoGate)
{
    const std::string lost = writeFile(files, "lost.txt", mostlyLost(6));
    const std::vector<std::vector<std::string>> gates{
        {"ate", truth, lost, "--max-rmse", "1"},
        {"rpe", truth, lost, "--fixed-delta", "--delta", "0.2", "--max-rmse", "1"},
        {"rpe", truth, lost, "--fixed-delta", "--delta", "0.2", "--max-rmse-deg", "1"}};
    for (std::vector<std::string> args : gates)
    {
        const test::AppRun r = run(args);
        EXPECT_EQ(r.code, 1);
        EXPECT_THAT(
            r.err,
            HasSubstr("lost.txt: coverage 10.0 % is below 50 %, too little for a threshold to be "
                      "passed; --min-coverage sets another limit\n"));
        args.insert(args.end(), {"--min-coverage", "10"});
        EXPECT_EQ(run(args).code, 0);
        EXPECT_THAT(run(args).err, HasSubstr("lost.txt: only 10.0 % of the recording was scored"));
        args.back() = "10.1";
        EXPECT_EQ(run(args).code, 1);
        EXPECT_THAT(run(args).err, HasSubstr("lost.txt: coverage 10.0 % is below 10.1 %"));
    }
    EXPECT_EQ(run({"ate", truth, lost}).code, 0);  // no gate
    for (const char* command : {"ate", "rpe", "compare"})
    {
        std::vector<std::string> args{command, truth, lost, "--delta", "0.2", "--fixed-delta"};
        args.resize(std::string(command) == "ate" ? 3 : 6);
        EXPECT_THAT(run(args).err, HasSubstr("lost.txt: only 10.0 % of the recording was scored"));
    }
    EXPECT_EQ(run({"ate", truth, estimate}).err, "");
    EXPECT_EQ(run({"ate", truth, lost, "--min-coverage", "50"}).code, 1);
    EXPECT_EQ(run({"compare", truth, lost, "--delta", "0.2", "--min-coverage", "50"}).code, 1);
    EXPECT_EQ(run({"ate", truth, lost, "--min-coverage", "101"}).code, 2);
}

/** Who scores a part against the whole ground truth lost nothing: a warning is enough. */
TEST_F(EvalApp, aGateOfAShortRunWithoutMarksIsWarnedOf)
{
    const std::string whole = straightLine(1);
    const std::string part = writeFile(files, "part.txt", whole.substr(0, whole.find("\n1 ") + 1));
    const test::AppRun r = run({"ate", truth, part, "--max-rmse", "1"});
    EXPECT_EQ(r.code, 0);
    EXPECT_THAT(
        r.err,
        HasSubstr("warning: " + part + ": only 18.0 % of the ground truth's time was scored"));
    EXPECT_EQ(run({"ate", truth, part, "--max-rmse", "1", "--min-coverage", "50"}).code, 1);
}

/** Three numbers of the alignment fit two positions. */
TEST_F(EvalApp, anAteOfFewPosesIsWarnedOf)
{
    const std::string line = straightLine(2);
    const auto run2 = [&](std::size_t numPoses)
    {
        std::size_t end = 0;
        for (std::size_t k = 0; k < numPoses; ++k)
        {
            end = line.find('\n', end) + 1;
        }
        return run({"ate", truth, writeFile(files, "few.txt", line.substr(0, end))});
    };
    EXPECT_EQ(run2(2).code, 0);
    EXPECT_THAT(run2(2).err, HasSubstr("few.txt: only 2 poses have ground truth; the alignment"));
    EXPECT_THAT(run2(10).err, testing::Not(HasSubstr("poses have ground truth")));
}

TEST_F(EvalApp, compareOfOneRunHasNoBest)
{
    const test::AppRun r = run({"compare", truth, estimate, "--json", files / "out.json"});
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_THAT(r.out, testing::StartsWith("Comparison of 1 run\n"));
    EXPECT_THAT(r.out, HasSubstr("give others to compare it with"));
    EXPECT_THAT(r.out, testing::Not(HasSubstr("* ")));
    EXPECT_THAT(r.out, testing::Not(HasSubstr("different frames")));
    EXPECT_TRUE(nlohmann::json::parse(test::readBytes(files / "out.json"))["bestAte"].is_null());
}

TEST_F(EvalApp, whoGivesUpIsNotTheBestInAte)
{
    const std::string lost = writeFile(files, "lost.txt", mostlyLost(26));
    const test::AppRun r =
        run({"compare", truth, estimate, lost, "--delta", "0.2", "--json", files / "out.json"});
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_THAT(r.out, HasSubstr("each run's own, so none is marked as the best in ATE"));
    const auto json = nlohmann::json::parse(test::readBytes(files / "out.json"));
    EXPECT_TRUE(json["bestAte"].is_null());
    EXPECT_EQ(json["bestTranslation"], lost);
    EXPECT_EQ(std::count(r.out.begin(), r.out.end(), '*'), 2) << r.out;
}

namespace
{
/** A run of 51 frames whose motion into one of them is off by a metre, with pictures and a table of
 * the frames. */
struct RunWithPictures
{
    test::TempDir dir;
    std::string estimate, table;

    /** \param jump frame of the jump \param isLost frames that have no pose */
    RunWithPictures(int jump, const std::function<bool(int)>& isLost)
    {
        std::string poses = "# pointplane-status: what such lines mean\n";
        table = "frame,stamp,status\n";
        for (int k = 0; k <= 50; ++k)
        {
            const std::string stamp = std::to_string(0.1 * k);
            poses += isLost(k) ? "# pointplane-status " + stamp + " lost: no depth\n"
                               : stamp + " " + stamp + (k < jump ? " 0" : " 1") + " 0 0 0 0 1\n";
            table += std::to_string(k) + "," + stamp + (isLost(k) ? ",lost\n" : ",tracked\n");
            char name[32];
            std::snprintf(name, sizeof name, "%06d.jpg", k);
            writeFile(dir, name, "JPEG " + std::to_string(k));
        }
        estimate = writeFile(dir, "run.txt", poses);
    }

    [[nodiscard]] test::AppRun report(const std::string& truth, const std::string& rows) const
    {
        const std::string csv = writeFile(dir, "frames.csv", rows);
        return run(
            {"ate",
             truth,
             estimate,
             "--report",
             dir / "r",
             "--diagnostics",
             csv,
             "--overlays",
             dir / "",
             "--json",
             dir / "r.json"});
    }
    [[nodiscard]] std::string html() const { return test::readBytes(dir / "r/index.html"); }
};
}  // namespace

/** Frames that are lost for a late stamp are in the table in order of the file. */
TEST_F(EvalApp, picturesAreThoseOfTheWorstFrames)
{
    const RunWithPictures made(30, [](int k) { return k >= 5 && k < 15; });
    std::string table = made.table;
    table.insert(table.find("\n26,") + 1, "99,2.5,lost\n");
    const test::AppRun r = made.report(truth, table);
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_THAT(made.html(), HasSubstr("Frame 30 at 3.00 s: motion off by 1000"));
    EXPECT_THAT(made.html(), HasSubstr(";base64,SlBFRyAzMA=="));  // JPEG 30
    EXPECT_THAT(made.html(), testing::Not(HasSubstr("Frame 99")));

    const test::AppRun uncounted =
        run({"ate", truth, made.estimate, "--report", made.dir / "r", "--overlays", made.dir / ""});
    EXPECT_EQ(uncounted.code, 2);
    EXPECT_THAT(uncounted.err, HasSubstr("--overlays requires --diagnostics"));

    const std::string bad = writeFile(files, "bad.csv", "frame,stamp\n1,0\n\n2,x\n");
    const test::AppRun refused =
        run({"ate", truth, estimate, "--report", files / "r", "--diagnostics", bad});
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr("bad.csv:4: the stamp is not a number"));
    EXPECT_THAT(
        run({"ate", truth, estimate, "--report", files / "r", "--diagnostics", "/proc/self/mem"})
            .err,
        HasSubstr("cannot read /proc/self/mem: "));
}

/** --first 20 --count 10: the rows of frames that were not run are not those of the nearest. */
TEST_F(EvalApp, aTableOfAPartHasPicturesOfItsOwnFramesAlone)
{
    const RunWithPictures made(5, [](int) { return false; });
    const std::size_t first = made.table.find("\n20,") + 1;
    const std::size_t end = made.table.find("\n30,") + 1;
    const test::AppRun r =
        made.report(truth, "frame,stamp,status\n" + made.table.substr(first, end - first));
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_THAT(
        r.err,
        HasSubstr(
            "warning: " + (made.dir / "frames.csv") + ": has rows of 10 of the 51 poses of " +
            made.estimate + "\n"));
    EXPECT_THAT(made.html(), testing::ContainsRegex("Frame 2[0-9] at 2[.]"));
    EXPECT_THAT(made.html(), testing::Not(testing::ContainsRegex("Frame 2[0-9] at [^2]")));
    EXPECT_THAT(made.html(), testing::Not(HasSubstr("motion off by 1000")));
}

TEST_F(EvalApp, aTableOfAnotherRunIsRefusedBeforeAnythingIsWritten)
{
    const RunWithPictures made(5, [](int) { return false; });
    const test::AppRun other =
        made.report(truth, "frame,stamp,status\n0,1e9,tracked\n1,1000000000.1,tracked\n");
    EXPECT_EQ(other.code, 2);
    EXPECT_THAT(other.err, HasSubstr("frames.csv: has none of the stamps of "));
    const test::AppRun noNumbers = made.report(truth, "stamp\n0.1\n");
    EXPECT_EQ(noNumbers.code, 2);
    EXPECT_THAT(noNumbers.err, HasSubstr("frames.csv:1: no column 'frame'"));
    const test::AppRun noPictures = made.report(truth, "frame,stamp\n1000,0.1\n");
    EXPECT_EQ(noPictures.code, 2);
    EXPECT_THAT(noPictures.err, HasSubstr("no picture 000001.jpg, ... of the frames of "));
    EXPECT_FALSE(std::filesystem::exists(made.dir / "r.json"));
    EXPECT_EQ(other.out + noNumbers.out + noPictures.out, "");
}

TEST_F(EvalApp, namesAreShownInOneLine)
{
    const std::string odd = writeFile(files, "a\n\tb\x1b[2J.txt", straightLine(1.05));
    const std::string shown = "a\\n\\tb\\x1b[2J.txt";
    for (const std::vector<std::string>& args :
         {std::vector<std::string>{"rpe", truth, odd, "--fixed-delta"},
          {"ate", odd, estimate},
          {"compare", truth, odd, estimate},
          {"rpe", odd, odd}})
    {
        const test::AppRun r = run(args);
        EXPECT_EQ(r.code, 0) << r.err;
        EXPECT_THAT(r.out, HasSubstr(shown)) << args.front();
        EXPECT_EQ((r.out + r.err).find_first_of("\t\x1b"), std::string::npos) << r.out << r.err;
        EXPECT_THAT(r.out + r.err, testing::Not(HasSubstr("/a\n")));
    }
    EXPECT_THAT(run({"rpe", odd, odd}).err, HasSubstr(shown + "' is the ground truth, too"));
}

/** At another rate, of a camera beside this one, or with other parameters. */
TEST_F(EvalApp, aTableOfAnotherRunOfTheRecordingIsRefused)
{
    const RunWithPictures made(5, [](int k) { return k == 7; });
    const auto tableOf = [](const std::function<std::string(int)>& row)
    {
        std::string out = "frame,stamp,status\n";
        for (int k = 0; k <= 50; ++k)
        {
            out += row(k);
        }
        return out;
    };
    const auto row = [](int k, double stamp, const char* status)
    { return std::to_string(k) + "," + std::to_string(stamp) + "," + status + "\n"; };
    const auto expect = [&](const std::string& table, const std::string& why)
    {
        const test::AppRun r = made.report(truth, table);
        EXPECT_EQ(r.code, 2);
        EXPECT_EQ(
            r.err,
            "pointplane-eval: " + (made.dir / "frames.csv") + ": " + why + made.estimate +
                "; give the table that --diagnostics wrote in the same run\n");
        EXPECT_EQ(r.out, "");
    };
    expect(
        tableOf([&](int k) { return k % 3 == 0 ? row(k, 0.1 * k, "tracked") : ""; }),
        "has no row that fits the pose at 0.100000 s of ");
    expect(
        tableOf([&](int k) { return row(k, 0.1 * k - 0.03, k == 7 ? "lost" : "tracked"); }),
        "has no row that fits the pose at 0.000000 s of ");
    expect(
        tableOf(
            [&](int k)
            {
                return row(2 * k, 0.1 * k, k == 7 ? "lost" : "tracked") +
                       row(2 * k + 1, 0.1 * k + 0.05, "tracked");
            }),
        "has a row at 0.050000 s, but there is no pose in ");
    expect(
        tableOf(
            [&](int k) {
                return row(k, 0.1 * k, k == 7 ? "lost" : k == 9 ? "predicted" : "tracked");
            }),
        "says 'predicted' of the frame at 0.900000 s, which is tracked in ");
    expect(
        tableOf([&](int k) { return row(k, 0.1 * k, "tracked"); }),
        "has a row at 0.700000 s, but there is no pose in ");
    EXPECT_EQ(made.report(truth, made.table).err.find("warning"), std::string::npos);
}

TEST_F(EvalApp, inputsOfAReportAreCheckedBeforeAnythingIsWritten)
{
    const std::string table = writeFile(files, "frames.csv", "frame,stamp\n1,0\n");
    const std::vector<std::pair<std::vector<std::string>, std::string>> refused{
        {{"--diagnostics", files / "nope.csv"}, "nope.csv: No such file or directory"},
        {{"--run-config", files / "nope.ini"}, "nope.ini: No such file or directory"},
        {{"--diagnostics", table, "--overlays", files / "nope"}, "nope: No such file or directory"},
        {{"--diagnostics", table, "--overlays", table}, "frames.csv: is not a folder"}};
    for (const auto& [options, message] : refused)
    {
        for (const char* command : {"rpe", "ate"})
        {
            std::vector<std::string> args{command, truth, estimate, "--json", files / "r.json"};
            args.insert(args.end(), {"--report", files / "r"});
            args.insert(args.end(), options.begin(), options.end());
            const test::AppRun r = run(args);
            EXPECT_EQ(r.code, 2);
            EXPECT_THAT(r.err, HasSubstr("cannot open "));
            EXPECT_THAT(r.err, HasSubstr(message));
            EXPECT_EQ(r.out, "");
            EXPECT_FALSE(std::filesystem::exists(files / "r.json"));
        }
    }
}

TEST_F(EvalApp, reportsOfOneRun)
{
    for (const char* command : {"rpe", "ate"})
    {
        const std::string directory = files / command;
        const test::AppRun r = run({command, truth, estimate, "--report", directory});
        EXPECT_EQ(r.code, 0) << r.err;
        EXPECT_THAT(r.err, HasSubstr("index.html"));
        EXPECT_THAT(test::readBytes(directory + "/index.html"), HasSubstr("Path from above"));
    }
    const test::AppRun noTable =
        run({"rpe", truth, estimate, "--report", files / "r", "--diagnostics", files / "none.csv"});
    EXPECT_EQ(noTable.code, 2);
    EXPECT_THAT(noTable.err, HasSubstr("none.csv"));
    EXPECT_EQ(run({"rpe", truth, estimate, "--report", truth}).code, 2);  // a file, no folder
}

TEST_F(EvalApp, reportsTellChartsOfAnEarlierOne)
{
    const std::string folder = files / "r";
    const std::string told = "index.html; SVG files beside it that are not of this report: ";
    for (int i = 0; i < 2; ++i)
    {
        EXPECT_THAT(
            run({"rpe", truth, estimate, "--report", folder}).err,
            testing::Not(HasSubstr("not of this report")));
    }
    writeFile(files, "r/nees-of-increments-of-1f.svg", "");
    EXPECT_THAT(
        run({"rpe", truth, estimate, "--report", folder}).err,
        HasSubstr(told + "1, e.g. nees-of-increments-of-1f.svg\n"));
}

TEST_F(EvalApp, reportsDoNotFollowLinks)
{
    const std::string folder = files / "r", before = test::readBytes(truth);
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"rpe", truth, estimate},
          {"ate", truth, estimate},
          {"compare", truth, estimate, estimate}})
    {
        std::filesystem::remove_all(folder);
        std::filesystem::create_directory(folder);
        for (const char* name : {"index.html", "path-from-above.svg"})
        {
            std::filesystem::create_symlink("../truth.txt", folder + "/" + name);
        }
        std::vector<std::string> args = command;
        args.insert(args.end(), {"--report", folder});
        const test::AppRun r = run(args);
        EXPECT_EQ(r.code, 0) << r.err;
        EXPECT_EQ(test::readBytes(truth), before) << command[0];
        EXPECT_THAT(test::readBytes(folder + "/index.html"), HasSubstr("<html")) << command[0];
        EXPECT_THAT(test::readBytes(folder + "/path-from-above.svg"), HasSubstr("<svg"));
    }
}

/** All pairs by default, a fixed delta if asked for: the report shows what the terminal shows. */
TEST_F(EvalApp, theReportShowsTheTerminalsFigures)
{
    for (const std::vector<std::string>& options :
         {std::vector<std::string>{}, {"--fixed-delta"}, {"--fixed-delta", "--delta", "2"}})
    {
        std::vector<std::string> args{
            "rpe", truth, estimate, "--report", files / "r", "--json", files / "r.json"};
        args.insert(args.end(), options.begin(), options.end());
        ASSERT_EQ(run(args).code, 0);
        const auto json = nlohmann::json::parse(test::readBytes(files / "r.json"));
        char rmse[32];
        std::snprintf(
            rmse, sizeof rmse, "<td>%#.4g</td>", 1000 * json["translation"]["rmse"].get<double>());
        const std::string html = test::readBytes(files / "r/index.html");
        EXPECT_THAT(html, HasSubstr(std::string("translation [mm]</td>") + rmse));
        EXPECT_THAT(html, HasSubstr(json["protocol"].get<std::string>().substr(0, 60)));
    }
}

TEST_F(EvalApp, theReportSaysHowItWasMade)
{
    const std::string config = writeFile(files, "run.ini", "[PoseSolver]\nalpha = 7\n");
    ASSERT_EQ(
        run({"ate", truth, estimate, "--report", files / "r", "--run-config", config}).code, 0);
    const std::string html = test::readBytes(files / "r/index.html");
    EXPECT_THAT(html, HasSubstr("pointplane-eval " POINTPLANE_VERSION ", 20"));
    EXPECT_THAT(html, HasSubstr("pointplane-eval ate " + truth));
    EXPECT_THAT(html, HasSubstr("alpha = 7"));
    EXPECT_THAT(test::readBytes(files / "r/path-from-above.svg"), HasSubstr("ground truth"));
    EXPECT_EQ(run({"ate", truth, estimate, "--report", files / "r", "--run-config", "no"}).code, 2);
    EXPECT_THAT(
        run({"ate", truth, estimate, "--report", files / "r", "--run-config", files / ""}).err,
        HasSubstr("cannot open " + files / "" + ": is a directory\n"));
    for (const auto& [text, why] :
         {std::pair(std::string("PK\x03\x04"), "is not text"),
          {std::string(2 << 20, 'x'), "is longer than 1 MiB"}})
    {
        const std::string bad = writeFile(files, "bad.ini", text);
        const test::AppRun r =
            run({"ate", truth, estimate, "--report", files / "r", "--run-config", bad});
        EXPECT_EQ(r.code, 2);
        EXPECT_THAT(r.err, HasSubstr(bad + ": " + why + "; give the configuration of the run\n"));
    }
    for (const char* part : {"--run-config", "--diagnostics"})
    {
        const test::AppRun refused = run({"ate", truth, estimate, part, config});
        EXPECT_EQ(refused.code, 2) << part;
        EXPECT_THAT(refused.err, HasSubstr(std::string(part) + " requires --report"));
    }
}

/** Half a second: no pairs 1 s apart. */
TEST_F(EvalApp, theReportOfAShortRunSaysWhatItLacks)
{
    std::string head;
    for (int line = 0; line < 6; ++line)
    {
        head += "0." + std::to_string(line) + " 0.1 0 0 0 0 0 1\n";
    }
    const std::string brief = writeFile(files, "short.txt", head);
    const test::AppRun r = run({"ate", truth, brief, "--report", files / "r"});
    EXPECT_EQ(r.code, 0) << r.err;
    const std::string html = test::readBytes(files / "r/index.html");
    EXPECT_THAT(html, HasSubstr("short.txt' covers 0.5 s: fewer than two pairs"));
    EXPECT_THAT(html, HasSubstr("Path from above"));
}

TEST_F(EvalApp, namesOfFilesCannotBreakAReport)
{
    const std::string evil = writeFile(files, "<!--<script>alert(1)&.txt", straightLine(1.1));
    ASSERT_EQ(run({"compare", truth, evil, estimate, "--report", files / "r"}).code, 0);
    const std::string html = test::readBytes(files / "r/index.html");
    EXPECT_THAT(html, testing::Not(HasSubstr("<!--")));
    EXPECT_THAT(html, HasSubstr("&lt;!--&lt;script&gt;alert(1)&amp;.txt"));
}

TEST_F(EvalApp, theStandardOutputTakesOneResult)
{
    for (const std::vector<std::string>& both :
         {std::vector<std::string>{"--json", "-", "--csv", "-"},
          {"--json", "-", "--verbose"},
          {"--save", "-", "--csv", "-"}})
    {
        std::vector<std::string> args{"ate", truth, estimate};
        args.insert(args.end(), both.begin(), both.end());
        const test::AppRun r = run(args);
        EXPECT_EQ(r.code, 2);
        EXPECT_THAT(r.err, HasSubstr("only one of --json, --csv, --save and --verbose"));
        EXPECT_EQ(r.out, "");
    }
}

/** JSON and HTML are in UTF-8, names of files may be in anything. */
TEST_F(EvalApp, namesInAnyEncodingAreWritten)
{
    const std::string latin = writeFile(files, "caf\xe9.txt", straightLine(1.1));
    const std::string utf8 = writeFile(files, "caf\xc3\xa9.txt", straightLine(1.1));
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"rpe", truth, latin},
          {"ate", latin, utf8},
          {"compare", truth, latin, utf8}})
    {
        std::vector<std::string> args = command;
        args.insert(args.end(), {"--json", "-", "--report", files / "r"});
        const test::AppRun r = run(args);
        EXPECT_EQ(r.code, 0) << r.err;
        EXPECT_THAT(nlohmann::json::parse(r.out).dump(), HasSubstr("caf\xef\xbf\xbd.txt"));
    }
    for (const char* file : {"r/index.html", "r/path-from-above.svg"})
    {
        const std::string text = test::readBytes(files / file);
        EXPECT_THAT(text, HasSubstr("caf\xc3\xa9.txt"));
        EXPECT_THAT(text, HasSubstr("caf\xef\xbf\xbd.txt"));
        EXPECT_EQ(text.find('\xe9'), std::string::npos);
    }
}

TEST_F(EvalApp, savesErrorsOneByOne)
{
    ASSERT_EQ(
        run({"rpe", truth, estimate, "--fixed-delta", "--save", files / "pairs.csv"}).code, 0);
    EXPECT_THAT(
        test::readBytes(files / "pairs.csv"),
        testing::StartsWith("stamp_i,stamp_j,translation_m,rotation_deg\n"
                            "0,1,0.05,0\n"));
    // Few poses: all ordered pairs, too.
    const std::string all = run({"rpe", truth, estimate, "--max-pairs", "0", "--save", "-"}).out;
    EXPECT_EQ(std::count(all.begin(), all.end(), '\n'), 51 * 51 + 1);

    ASSERT_EQ(
        run({"ate", truth, estimate, "--align", "none", "--save", files / "poses.csv"}).code, 0);
    const std::string poses = test::readBytes(files / "poses.csv");
    EXPECT_THAT(poses, testing::StartsWith("stamp,translation_m,x_m,y_m,z_m\n"));
    EXPECT_THAT(poses, HasSubstr("\n1,0.05,0.05,0,0\n"));
}

/** Its errors were those of where an odometry begins, without a word. */
TEST_F(EvalApp, withoutAlignmentAteTellsOfWorldsThatDiffer)
{
    const std::string other = files / "other.txt";
    const auto turned = [&](const std::string& quaternion)
    {
        std::ofstream out(other);
        for (int i = 0; i <= 50; ++i)
        {
            out << 0.1 * i << " 7 " << 0.101 * i << " 0 " << quaternion << "\n";
        }
    };
    const std::string hint =
        "/other.txt' in another world than the ground truth? (--body-from-gt does not change";
    turned("0 0 0.707106781 0.707106781");
    EXPECT_THAT(run({"ate", truth, other, "--align", "none"}).err, HasSubstr(hint));
    EXPECT_EQ(run({"ate", truth, other}).err, "");
    EXPECT_EQ(run({"ate", truth, estimate, "--align", "none"}).err, "");
    turned("0.707106781 0 0.707106781 0");
    EXPECT_THAT(
        run({"ate", truth, other, "--align", "none", "--body-from-gt", "optical"}).err,
        HasSubstr(hint));
}

/** 1305031102.160407 was 1305031102.160407066. */
TEST_F(EvalApp, savesStampsThatReadBackAndValuesToSixDigits)
{
    const std::string fine = writeFile(
        files,
        "fine.txt",
        "1305031102.160407 0 0 0 0 0 0 1\n1305031102.19433 0.1234567891 0 0 0 0 0 1\n"
        "1500000000 0.2 0 0 0 0 0 1\n");
    EXPECT_EQ(
        run({"ate", fine, fine, "--scale", "2", "--align", "none", "--save", "-"}).out,
        "stamp,translation_m,x_m,y_m,z_m\n1305031102.160407,0,0,0,0\n"
        "1305031102.19433,0.123457,0.123457,0,0\n1500000000,0.2,0.2,0,0\n");
}

TEST_F(EvalApp, marksOfLostAndPredictedFramesAreReadAndSaid)
{
    std::string marked = "# pointplane-status: what such lines mean\n";
    std::istringstream lines(straightLine(1.05));
    int k = 0;
    for (std::string line; std::getline(lines, line); ++k)
    {
        const std::string stamp = line.substr(0, line.find(' '));
        const bool isLost = k >= 20 && k < 40;
        marked += isLost ? "# pointplane-status " + stamp + " lost: no depth\n"
                  : k == 40
                      ? "# pointplane-status " + stamp + " predicted: no points\n" + line + "\n"
                      : line + "\n";
    }
    const std::string path = writeFile(files, "marked.txt", marked);
    const std::string counts =
        "coverage 58.0 % of the recording: 30 frames tracked, 1 predicted, 20 lost";
    EXPECT_THAT(run({"ate", truth, path}).out, HasSubstr(counts));
    EXPECT_THAT(run({"rpe", truth, path, "--fixed-delta"}).out, HasSubstr(counts));
    const auto json = nlohmann::json::parse(run({"ate", truth, path, "--json", "-"}).out);
    EXPECT_EQ(json["coverage"]["frames"]["lost"], 20);
    EXPECT_EQ(json["coverage"]["of"], "recording");
    EXPECT_NEAR(json["coverage"]["ofGroundTruth"], 0.58, 0.001);
    const std::vector<std::string> both{"compare", truth, path, estimate, "--delta", "0.2"};
    EXPECT_THAT(run(both).out, testing::ContainsRegex("marked.txt .* 58.0 % +1 +20\n"));
    EXPECT_THAT(run(both).out, testing::ContainsRegex("estimate.txt .* 100.0 % +- +-\n"));
    std::vector<std::string> asCsv = both;
    asCsv.insert(asCsv.end(), {"--csv", "-"});
    EXPECT_THAT(run(asCsv).out, HasSubstr(",predicted,lost\n"));
    EXPECT_THAT(run(asCsv).out, testing::ContainsRegex("marked.txt,.*,1,20\n"));
    EXPECT_THAT(run(asCsv).out, testing::ContainsRegex("estimate.txt,.*,,\n"));
    EXPECT_THAT(
        run({"ate", truth, estimate}).out,
        HasSubstr("of the ground truth's time, frames not marked"));
    const std::string bad =
        writeFile(files, "bad.txt", "# pointplane-status 1 gone\n" + straightLine(1));
    const test::AppRun refused = run({"ate", truth, bad});
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr("bad.txt:1: not a status"));
}

/** Who reads the score sees that it is of a changed estimate. */
TEST_F(EvalApp, theProtocolTellsWhatWasChanged)
{
    EXPECT_THAT(
        run({"rpe", truth, estimate, "--scale", "2", "--offset", "0.001"}).out,
        HasSubstr("at the nearest stamp, estimate's stamps +0.001 s and translations times 2, "));
    EXPECT_THAT(
        run({"ate", truth, estimate, "--scale", "0.5"}).out,
        HasSubstr("association 0.02 s, estimate's translations times 0.5, "));
    EXPECT_THAT(
        run({"compare", truth, estimate, "--offset", "-0.001"}).out,
        HasSubstr("estimate's stamps -0.001 s, "));
    EXPECT_THAT(run({"rpe", truth, estimate}).out, testing::Not(HasSubstr("estimate's")));
}

/** A truth that jumps looks like an estimate that does: the scores are alike. */
TEST_F(EvalApp, trajectoriesInTheWrongOrderAreWarnedOf)
{
    const std::string marked = writeFile(files, "marked.txt", mostlyLost(30));
    for (const char* command : {"rpe", "ate", "compare"})
    {
        const test::AppRun swapped = run({command, marked, truth});
        EXPECT_EQ(swapped.code, 0) << swapped.err;
        EXPECT_THAT(
            swapped.err,
            HasSubstr(
                "warning: '" + marked + "' has marks of tracked and lost frames, and '" + truth +
                "' has not; is the ground truth given first?\n"));
        for (const std::string& first : {truth, marked})
        {
            EXPECT_THAT(run({command, first, marked}).err, testing::Not(HasSubstr("given first")));
        }
    }
}

/** Its errors are zero, and pass any limit. */
TEST_F(EvalApp, aGroundTruthThatIsTheEstimateIsWarnedOf)
{
    std::filesystem::create_symlink(truth, files / "link.txt");
    for (const char* command : {"rpe", "ate", "compare"})
    {
        for (const std::string& same : {truth, files / "link.txt"})
        {
            const test::AppRun r = run({command, truth, same});
            EXPECT_EQ(r.code, 0) << r.err;
            EXPECT_THAT(r.err, HasSubstr("warning: '" + same + "' is the ground truth, too"));
        }
        EXPECT_THAT(run({command, truth, estimate}).err, testing::Not(HasSubstr("too: nothing")));
    }
}

/** All pairs have every distance: --delta without --fixed-delta would be ignored. */
TEST_F(EvalApp, aDeltaWithoutEffectIsRefused)
{
    for (const std::vector<std::string>& delta :
         {std::vector<std::string>{"--delta", "0.5"}, {"--delta-unit", "f"}})
    {
        std::vector<std::string> args{"rpe", truth, estimate};
        args.insert(args.end(), delta.begin(), delta.end());
        const test::AppRun refused = run(args);
        EXPECT_EQ(refused.code, 2);
        EXPECT_THAT(refused.err, HasSubstr("--fixed-delta"));
        args.emplace_back("--fixed-delta");
        EXPECT_EQ(run(args).code, 0);
        args[0] = "compare";
        args.back() = estimate;
        EXPECT_EQ(run(args).code, 0);
    }
    EXPECT_THAT(run({"rpe", "--help"}).out, HasSubstr("--fixed-delta"));
    EXPECT_THAT(run({"compare", "--help"}).out, testing::Not(HasSubstr("--fixed-delta")));
}

TEST_F(EvalApp, failuresSayWhyAndSetTheExitCode)
{
    const test::AppRun nothing = run({}), unknown = run({"mean", truth});
    EXPECT_EQ(nothing.code, 2);
    EXPECT_EQ(unknown.code, 2);
    EXPECT_THAT(nothing.err, HasSubstr("no command; commands are rpe, ate, nees, compare ("));
    EXPECT_THAT(unknown.err, HasSubstr("unknown command 'mean'; commands are rpe, "));
    const test::AppRun compressed =
        run({"ate", truth, writeFile(files, "rawlog.txt", "\x1f\x8b\x08")});
    EXPECT_EQ(compressed.code, 2);
    EXPECT_THAT(compressed.err, HasSubstr("rawlog.txt: is compressed, not text"));
    EXPECT_EQ(run({"rpe", truth}).code, 2);
    EXPECT_EQ(run({"rpe", truth, estimate, "--delta", "x"}).code, 2);
    EXPECT_EQ(run({"--help"}).code, 0);
    EXPECT_EQ(run({"--version"}).code, 0);

    const test::AppRun missing = run({"rpe", truth, files / "none.txt"});
    EXPECT_EQ(missing.code, 2);
    EXPECT_THAT(missing.err, HasSubstr("none.txt: No such file or directory\n"));

    const test::AppRun unwritable =
        run({"rpe", truth, estimate, "--fixed-delta", "--json", files / "no/dir.json"});
    EXPECT_EQ(unwritable.code, 3);
    EXPECT_THAT(unwritable.err, HasSubstr("no/dir.json"));
}

TEST_F(EvalApp, noOutputIsAnInput)
{
    for (const char* option : {"--json", "--csv", "--save"})
    {
        for (const std::string& input : {truth, estimate})
        {
            const std::string before = test::readBytes(input);
            const test::AppRun r = run({"ate", truth, estimate, option, input});
            EXPECT_EQ(r.code, 2);
            EXPECT_THAT(r.err, testing::AllOf(HasSubstr(option), HasSubstr("is an input")));
            EXPECT_EQ(test::readBytes(input), before);
        }
    }
    EXPECT_EQ(run({"ate", truth, estimate, "--json", files / "x", "--csv", files / "x"}).code, 2);
}

TEST_F(EvalApp, warningsOfTheReaderReachTheUser)
{
    const std::string withNan =
        writeFile(files, "nan.txt", straightLine(1) + "9 nan 0 0 0 0 0 1\n");
    EXPECT_THAT(run({"ate", truth, withNan}).err, HasSubstr("warning: "));
}

TEST_F(EvalApp, sparseGroundTruthIsToldOf)
{
    std::string sparse;
    for (int i = 0; i <= 5; ++i)
    {
        sparse += std::to_string(i) + " " + std::to_string(i) + " 0 0 0 0 0 1\n";
    }
    const std::string seconds = writeFile(files, "seconds.txt", sparse);
    const std::string warning = "has a pose every 1 s, '" + estimate + "' every 0.1 s";
    const std::vector<std::vector<std::string>> commands{
        {"rpe", seconds, estimate, "--fixed-delta"}, {"compare", seconds, estimate, estimate}};
    for (const std::vector<std::string>& args : commands)
    {
        EXPECT_THAT(run(args).err, HasSubstr(warning));
    }
    // Its poses are compared with those of their own time only.
    EXPECT_THAT(run({"ate", seconds, estimate}).err, testing::Not(HasSubstr("has a pose every")));
    EXPECT_THAT(
        run({"rpe", truth, estimate, "--fixed-delta"}).err,
        testing::Not(HasSubstr("has a pose every")));
}

/** Each error counts by its own sigma. */
TEST(NeesOutput, tellsWhereRootMeanSquaresMislead)
{
    NeesReport report;
    NeesResult& result = report.results.emplace_back();
    const std::string told = "\nx: rms error is below rms sigma, but";
    for (const bool optimistic : {true, false})
    {
        result.joint = {optimistic ? 2.0 : 1.0, 0.5, 1.5};
        result.axes[0] = {{3, 0.5, 1.5}, 0, 1, 2};
        std::ostringstream out;
        printTable(report, out);
        EXPECT_EQ(out.str().find(told) != std::string::npos, optimistic) << out.str();
    }
}
