// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <map>
#include <new>
#include <sstream>

#include "LabApp.h"
#include "StopSignals.h"
#include "reproduce_output.h"
#include "run_app.h"
#include "run_processes.h"
#include "test_trajectories.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

using namespace pointplane;
using testing::HasSubstr;

namespace
{
test::AppRun run(const std::vector<std::string>& args) { return test::runApp(runLab, args); }

/** 51 poses along x at 10 Hz, 1 m/s times `factor`. */
std::string straightLine(const std::string& factor)
{
    return "awk 'BEGIN{for(i=0;i<=50;++i) printf \"%g %g 0 0 0 0 0 1\\n\", 0.1*i, 0.1*i*" + factor +
           "}'";
}

/** Programs that behave like pointplane-odometry and -convert as far as these tests go. */
class FakePrograms : public testing::Test
{
 protected:
    FakePrograms()
    {
        // The factor of the drift is the value of the last --set; "bad" is refused.
        odometry = script(
            "odometry",
            "factor=1.01\n"
            "while [ $# -gt 0 ]; do case $1 in --trajectory) t=$2;; --set) s=$2;; esac; shift; "
            "done\n"
            "case $s in *bad) echo \"unknown value 'bad'\"; exit 2;; *alpha=*) factor=${s#*=};; "
            "esac\n" +
                straightLine("'$factor'") + " > $t\n");
        convert = script(
            "convert", "touch $4; " + straightLine("1") + " > ${4%.rawlog}.groundtruth.txt\n");
        simulate = script(
            "simulate", "touch $3; " + straightLine("1") + " > ${3%.rawlog}.groundtruth.txt\n");
    }

    std::string script(const std::string& name, const std::string& body) const
    {
        const std::string path = writeFile(dir, name, "#!/bin/sh\n" + body);
        chmod(path.c_str(), 0755);
        return path;
    }

    test::TempDir dir;
    std::string odometry, convert, simulate;
};
}  // namespace

TEST(RunProcesses, runsAllAndReportsExitCodes)
{
    test::TempDir dir;
    std::vector<ProcessJob> jobs;
    for (const char* script : {"echo a; echo; exit 0", "exit 3", "kill -9 $$"})
    {
        jobs.push_back({{"sh", "-c", script}, dir / ("log" + std::to_string(jobs.size()))});
    }
    jobs.push_back({{"/no/such/program"}, dir / "log3"});
    std::map<std::size_t, int> codes;
    runProcesses(jobs, 2, [&](std::size_t job, int code) { codes[job] = code; });
    EXPECT_EQ(codes, (std::map<std::size_t, int>{{0, 0}, {1, 3}, {2, 137}, {3, 127}}));
    EXPECT_EQ(lastLine(dir / "log0"), "a");
    EXPECT_EQ(lastLine(dir / "none"), "");
}

TEST(RunProcesses, anErrorInWhoIsToldIsPassedOn)
{
    test::TempDir dir;
    const std::vector<ProcessJob> jobs(4, {{"true"}, dir / "log"});
    const auto fails = [](std::size_t, int) { throw std::bad_alloc(); };
    EXPECT_THROW(runProcesses(jobs, 2, fails), std::bad_alloc);
    runProcesses({}, 2, fails);  // nothing to do
}

TEST(RunProcesses, aSignalEndsTheProgramsAndTheRuns)
{
    test::TempDir dir;
    std::vector<ProcessJob> jobs;
    for (const char* log : {"log0", "log1", "log2"})
    {
        jobs.push_back({{"sh", "-c", "echo $$; kill -TERM $PPID; exec sleep 100"}, dir / log});
    }
    int done = 0;
    installStopSignals();
    EXPECT_THROW(runProcesses(jobs, 1, [&](std::size_t, int) { ++done; }), EnvironmentError);
    EXPECT_EQ(done, 0);
    EXPECT_EQ(::kill(std::stoi(lastLine(dir / "log0")), 0), -1);
    EXPECT_FALSE(std::filesystem::exists(dir / "log1"));
    installStopSignals();  // for the next test
}

/** The last second and a half is lost. */
TEST_F(FakePrograms, lostFramesAreInTheTablesOfReproduce)
{
    std::filesystem::create_directories(dir / "s/rgbd_dataset_freiburg1_desk");
    for (const char* file : {"rgb.txt", "depth.txt", "groundtruth.txt"})
    {
        std::ofstream(dir / ("s/rgbd_dataset_freiburg1_desk/" + std::string(file)))
            << "12.5 rgb/a.png\n";
    }
    const std::string loses = script(
        "loses",
        "while [ $# -gt 0 ]; do case $1 in --trajectory) t=$2;; esac; shift; done\n" +
            straightLine("1.01") +
            " | awk 'NR<37; NR>36{print \"# pointplane-status \" $1 "
            "\" lost: x\"}' > $t\n");
    const test::AppRun r = run(
        {"reproduce",
         dir / "s",
         "--paper-config",
         writeFile(dir, "config-paper.ini", ""),
         "--only",
         "tables,alpha,corner",
         "--alphas",
         "1,2",
         "--odometry",
         loses,
         "--convert",
         convert,
         "--simulate",
         simulate,
         "--csv",
         dir / "out.csv",
         "--json",
         dir / "out.json"});
    EXPECT_THAT(r.out, HasSubstr("n l: n frames were lost."));
    EXPECT_THAT(r.out, HasSubstr("| 10.0 / 0.00 (15 l) |"));
    EXPECT_THAT(r.out, HasSubstr("| smallest mm at | 1 (15 l) "));
    EXPECT_THAT(r.out, HasSubstr("| 35.0, lost from 3.5 to 5.0 s "));
    EXPECT_THAT(test::readBytes(dir / "out.csv"), HasSubstr(",0.7,0,15,0.01"));
    const auto corner = nlohmann::json::parse(test::readBytes(dir / "out.json"))["corner"][0];
    EXPECT_EQ(corner["finalTime"], 3.5);
    EXPECT_EQ(corner["coverage"]["frames"]["lost"], 15);
}

TEST_F(FakePrograms, sweepScoresEveryValue)
{
    const std::string rawlog = writeFile(dir, "a.rawlog", "");
    ASSERT_EQ(std::system((straightLine("1") + " > " + (dir / "a.groundtruth.txt")).c_str()), 0);
    const test::AppRun r = run(
        {"sweep",
         "PoseSolver.alpha",
         rawlog,
         "--range",
         "1.1,1.3,3",
         "--odometry",
         odometry,
         "--report",
         dir / "report",
         "--csv",
         dir / "out.csv"});
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_THAT(r.out, HasSubstr("1.2               200.0 mm / 0.00 deg"));
    EXPECT_THAT(r.err, HasSubstr("[3/3, 0 s left]"));
    EXPECT_THAT(test::readBytes(dir / "out.csv"), HasSubstr("a,PoseSolver.alpha,1.3,40,1,0,0,0.3"));
    EXPECT_THAT(test::readBytes(dir / "report/index.html"), HasSubstr("Sweep of PoseSolver.alpha"));
}

/** Lists end at their value: what stands behind them is the key and the rawlogs. */
TEST_F(FakePrograms, optionsOfASweepMayStandBeforeItsRawlogs)
{
    const std::string truth = dir / "a.groundtruth.txt", both = truth + "," + truth;
    ASSERT_EQ(std::system((straightLine("1") + " > " + truth).c_str()), 0);
    for (const std::vector<std::string>& option :
         {std::vector<std::string>{"--gt", both, "--values", "1.1,1.2"},
          {"--values=1.1", "--gt", both},
          {"--gt", both, "--range", "1,2,3"}})
    {
        std::vector<std::string> args{"sweep", "--odometry", odometry};
        args.insert(args.end(), option.begin(), option.end());
        args.insert(
            args.end(),
            {"PoseSolver.alpha", writeFile(dir, "a.rawlog", ""), writeFile(dir, "b.rawlog", "")});
        const test::AppRun r = run(args);
        EXPECT_EQ(r.code, 0) << option.front() << ": " << r.err;
    }
}

TEST_F(FakePrograms, sweepTakesEachRawlogAndEachValueOnce)
{
    const std::string rawlog = writeFile(dir, "a.rawlog", ""), link = dir / "b.rawlog";
    std::filesystem::create_symlink("a.rawlog", link);
    for (const char* name : {"a.groundtruth.txt", "b.groundtruth.txt"})
    {
        ASSERT_EQ(std::system((straightLine("1") + " > " + (dir / name)).c_str()), 0);
    }
    const auto expect = [&](const std::vector<std::string>& more, const std::string& repeated)
    {
        std::vector<std::string> args{"sweep", "PoseSolver.alpha", rawlog, "--odometry", odometry};
        args.insert(args.end(), more.begin(), more.end());
        const test::AppRun r = run(args);
        EXPECT_EQ(r.code, 2) << r.out;
        EXPECT_EQ(r.err, "pointplane-lab: " + repeated + " is given more than once\n");
    };
    expect({rawlog, "--values", "1"}, "'" + rawlog + "'");
    expect({link, "--values", "1"}, "'" + link + "'");
    expect({"--values", "1,2,1"}, "the value 1");
    expect({"--values", "1,1.0"}, "the value 1.0");
    expect({"--values", "surf,orb,surf"}, "the value surf");
    expect({"--range", "1,1,3"}, "the value 1");
}

TEST_F(FakePrograms, aSweepThatCannotWorkIsRefusedBeforeItsRuns)
{
    const std::string rawlog = writeFile(dir, "a.rawlog", "");
    ASSERT_EQ(std::system((straightLine("1") + " > " + (dir / "a.groundtruth.txt")).c_str()), 0);
    const auto expect = [&](const std::vector<std::string>& more, const std::string& why)
    {
        std::vector<std::string> args{"sweep", "--odometry", odometry, "--values", "1,2"};
        args.insert(args.end(), more.begin(), more.end());
        args.push_back(rawlog);
        const test::AppRun r = run(args);
        EXPECT_EQ(r.code, 2);
        EXPECT_EQ(r.out, "");
        EXPECT_THAT(r.err, HasSubstr(why));
        EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
    };
    expect({"Pose.alpha"}, "setting 'Pose.alpha=1': unknown section [Pose]");
    expect({"alpha"}, "setting 'alpha=1': expected Section.key=value");
    expect({"--set", "PoseSolver.alpha=3", "PoseSolver.alpha"}, "alpha is set twice");
    expect({"-c", dir / "none.ini", "PoseSolver.alpha"}, "none.ini: No such file");
}

TEST_F(FakePrograms, linksInTheFoldersOfASweepAreNotFollowed)
{
    const std::string rawlog = writeFile(dir, "a.rawlog", "");
    const std::string truth = dir / "a.groundtruth.txt", keep = dir / "kept";
    ASSERT_EQ(std::system((straightLine("1") + " > " + truth).c_str()), 0);
    const std::string before = test::readBytes(truth);
    std::filesystem::create_directory(keep);
    for (const char* name :
         {"index.html", "000_a_PoseSolver.alpha=1.1.txt", "000_a_PoseSolver.alpha=1.1.log"})
    {
        std::filesystem::create_symlink("../a.groundtruth.txt", keep + "/" + name);
    }
    const test::AppRun r = run(
        {"sweep",
         "PoseSolver.alpha",
         rawlog,
         "--values",
         "1.1",
         "--odometry",
         odometry,
         "--keep",
         keep,
         "--report",
         keep});
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_EQ(test::readBytes(truth), before);
    EXPECT_THAT(test::readBytes(keep + "/index.html"), HasSubstr("<html"));
}

TEST_F(FakePrograms, rawlogsOfOneNameAreToldApart)
{
    std::vector<std::string> args{"sweep", "PoseSolver.alpha"};
    for (const std::string folder : {"one", "other"})
    {
        std::filesystem::create_directory(dir / folder);
        args.push_back(writeFile(dir, folder + "/s.rawlog", ""));
        ASSERT_EQ(
            std::system(
                (straightLine("1") + " > " + std::string(dir / folder) + "/s.groundtruth.txt")
                    .c_str()),
            0);
    }
    args.insert(args.end(), {"--values", "1.1", "--odometry", odometry, "--csv", dir / "out.csv"});
    const test::AppRun r = run(args);
    EXPECT_EQ(r.code, 0) << r.err;
    for (const std::string name : {"/one", "/other"})
    {
        EXPECT_THAT(r.out, HasSubstr(name));
        EXPECT_THAT(
            test::readBytes(dir / "out.csv"),
            HasSubstr(dir / (name.substr(1) + "/s.rawlog,PoseSolver")));
    }
}

TEST_F(FakePrograms, aFailedRunIsSaidAndTheOthersAreKept)
{
    const std::string rawlog = writeFile(dir, "a.rawlog", "");
    ASSERT_EQ(std::system((straightLine("1") + " > " + (dir / "a.groundtruth.txt")).c_str()), 0);
    const test::AppRun r = run(
        {"sweep",
         "PoseSolver.alpha",
         rawlog,
         "--values",
         "1.1,bad",
         "--odometry",
         odometry,
         "--keep",
         dir / "kept"});
    EXPECT_EQ(r.code, 1);
    EXPECT_THAT(r.out, testing::AllOf(HasSubstr("100.0 mm"), HasSubstr("failed")));
    EXPECT_THAT(r.err, HasSubstr("exit code 2, unknown value 'bad'"));
    EXPECT_THAT(
        r.err, HasSubstr("\npointplane-lab: 1 of 2 runs failed, first a PoseSolver.alpha=bad: "));
    EXPECT_TRUE(std::filesystem::exists(dir / "kept/000_a_PoseSolver.alpha=1.1.txt"));

    const auto noProgram = run(
        {"sweep",
         "a.b",
         rawlog,
         "--values",
         "1",
         "--odometry",
         "/no/such",
         "--keep",
         dir / "kept2"});
    EXPECT_EQ(noProgram.code, 2);
    EXPECT_EQ(
        noProgram.err, "pointplane-lab: cannot run '/no/such'; name the program by --odometry\n");
    EXPECT_FALSE(std::filesystem::exists(dir / "kept2"));
    EXPECT_EQ(run({"sweep", "a.b", dir / "none.rawlog", "--values", "1"}).code, 2);
    EXPECT_EQ(run({"sweep", "a.b", rawlog}).code, 2);  // nothing to try
    EXPECT_EQ(run({"sweep", "a.b", rawlog, "--range", "0,1,3", "--log"}).code, 2);
    EXPECT_EQ(run({"sweep", "a.b", rawlog, "--range", "0,1"}).code, 2);
}

TEST(ReproducePlan, namesOfSequences)
{
    bool isPart = true;
    EXPECT_EQ(sequenceName("rgbd_dataset_freiburg1_desk", isPart), "fr1/desk");
    EXPECT_FALSE(isPart);
    EXPECT_EQ(
        sequenceName("tum_fr3_structure_notexture_far_part", isPart),
        "fr3/structure_notexture_far");
    EXPECT_TRUE(isPart);
    EXPECT_EQ(sequenceName("icl_living_room_kt0_part", isPart), "icl_living_room_kt0");
    EXPECT_EQ(sequenceName("mine", isPart), "mine");
    EXPECT_FALSE(isPart);
}

TEST_F(FakePrograms, reproduceWritesTheTablesAndWhatIsMissing)
{
    const std::string sequences = dir / "sequences";
    for (const char* name : {"rgbd_dataset_freiburg1_desk", "tum_fr1_360_part"})
    {
        std::filesystem::create_directories(sequences + "/" + name);
        for (const char* file : {"rgb.txt", "depth.txt", "groundtruth.txt"})
        {
            std::ofstream(sequences + "/" + name + "/" + file)
                << "# stamp file\n12.5 rgb/a.png\n17.5 rgb/b.png\n";
        }
    }
    const std::string config = writeFile(dir, "config-paper.ini", "");
    const test::AppRun r = run(
        {"reproduce",
         sequences,
         "--paper-config",
         config,
         "--alphas",
         "1.1,bad",
         "--odometry",
         odometry,
         "--convert",
         convert,
         "--simulate",
         simulate,
         "--report",
         dir / "report",
         "--figure",
         dir / "figures",
         "--json",
         dir / "out.json"});
    EXPECT_EQ(r.code, 1) << r.err;  // one run failed
    EXPECT_THAT(
        r.out, HasSubstr("| fr1/desk       | 10.0 / 0.00 | 43 / 2.3  | 10.0 / 0.00 | 38 / 2.2 |"));
    EXPECT_THAT(r.out, HasSubstr("| fr1/360 (part) | 12.5        | 17.5       | 2 "));
    EXPECT_THAT(r.out, HasSubstr("### Table 2"));
    EXPECT_THAT(r.out, HasSubstr("| fr3/cabinet                 | not at hand | fail "));
    // 5 m at 1 % of drift.
    EXPECT_THAT(r.out, HasSubstr("| planes            | 50.0 "));
    EXPECT_THAT(r.out, HasSubstr("| 1.1            | 100.0 / 0.00 | 100.0 / 0.00   |"));
    EXPECT_THAT(
        r.out,
        HasSubstr("Missing of the paper's sequences: fr3/structure_notexture_far, fr3/cabinet. "
                  "Only a part, so not comparable with the published figure as it stands: "
                  "fr1/360."));
    EXPECT_THAT(r.out, HasSubstr("- fr1/desk, alpha, bad: pointplane-odometry: exit code 2"));
    EXPECT_EQ(nlohmann::json::parse(test::readBytes(dir / "out.json"))["runs"].size(), 36u);
    for (const char* name : {"translation", "rotation"})
    {
        EXPECT_THAT(
            test::readBytes(dir / "figures/paper_fig3_" + name + ".svg"), HasSubstr("<svg"));
    }
    const std::string html = test::readBytes(dir / "report/index.html");
    EXPECT_THAT(html, HasSubstr("Fig. 3"));
    EXPECT_THAT(html, HasSubstr(">bad</text>"));

    EXPECT_EQ(run({"reproduce", dir / "nowhere", "--paper-config", config}).code, 2);
}
