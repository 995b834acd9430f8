// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/HtmlReport.h>
#include <pointplane/evaluation/trajectory_charts.h>

#include <cstdlib>
#include <string>

#include "test_trajectories.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

using namespace pointplane;
using testing::HasSubstr;

namespace
{
/** Runs Chromium without a screen and without a network. \return its exit code */
int browse(const test::TempDir& dir, const std::string& page, int width, const std::string& action)
{
    const std::string command =
        "timeout 100 chromium --headless --no-sandbox --disable-gpu --allow-file-access-from-files "
        "--host-resolver-rules='MAP * ~NOTFOUND' --virtual-time-budget=5000 --user-data-dir=" +
        (dir / "profile") + " --window-size=" + std::to_string(width) + ",1500 " + action +
        " file://" + (dir / page) + " 2>" + (dir / "log");
    return std::system(command.c_str());
}

/** A report with every kind of content, drawn from a real comparison. */
std::string sampleReport(const test::TempDir& dir)
{
    const Trajectory truth = randomTrajectory(300, 1);
    const Trajectory estimate = odometry(truth, 2);
    RpeOptions options;
    options.fixedDelta = true;
    const auto increments = neesIncrements(truth, estimate, {}, {});
    HtmlReport report("A run with quite a long name that has to wrap on a phone", "sub/title");
    // The widest table that there is.
    std::vector<std::string> header{"increments of", "verdict", "independent increments", "joint"};
    std::vector<std::string> row{
        "10 frames", "optimistic, sigmas x 12.34 too small", "12345", "123.45"};
    for (const char* name : {"translation", "rotation", "x", "y", "z", "rx", "ry", "rz", "bounds"})
    {
        header.emplace_back(name);
        row.emplace_back("123.45");
    }
    row.back() = "0.95 - 1.05";
    report.addTable("a table wider than a phone", header, {row}, "its detail");
    const AteResult ate = absoluteTrajectoryError(truth, estimate, {});
    for (const std::vector<Chart>& charts :
         {pathCharts(truth, {{"estimate", estimate, ate}}),
          relativeErrorCharts(estimate, options, relativePoseError(truth, estimate, options)),
          poseCharts(truth, estimate, {}, ate)})
    {
        for (const Chart& chart : charts)
        {
            report.addChart(chart);
        }
    }
    report.addChart(neesChart(
        estimate, increments, consistencyOf(increments, increments.size(), NeesInterval())));
    const std::string table = writeFile(
        dir,
        "frames.csv",
        "stamp,status,numPoints,numPlanes,msTotal\n1,first,9,2,5\n2,lost,0,0,4\n3,tracked,8,3,6\n");
    for (const Chart& chart : frameCharts(FrameTable::read(table), 0))
    {
        report.addChart(chart);
    }
    return report.html();
}
}  // namespace

TEST(ReportInBrowser, fitsPhoneDeskAndPaper)
{
    if (std::system("command -v chromium >/dev/null 2>&1") != 0)
    {
        GTEST_SKIP() << "no chromium";
    }
    test::TempDir dir;
    (void)writeFile(dir, "index.html", sampleReport(dir));
    // A window cannot be narrower than 500 pixels, a frame can.
    (void)writeFile(
        dir,
        "phone.html",
        "<body style='margin:0'><iframe id=f src=index.html style='width:390px;height:1400px;"
        "border:0'></iframe><script>onload=()=>{const d=f.contentDocument.documentElement;"
        "document.body.dataset.result=f.contentWindow.innerWidth+' '+d.dataset.overflow;"
        "document.body.dataset.readable=[...d.querySelectorAll('svg.plot')]"
        ".every(s=>s.getScreenCTM().a>0.85)}</script>");

    ASSERT_EQ(browse(dir, "index.html", 1300, "--dump-dom >" + (dir / "desk.dom")), 0)
        << test::readBytes(dir / "log");
    EXPECT_THAT(
        test::readBytes(dir / "desk.dom").substr(0, 300),
        testing::AllOf(HasSubstr("data-overflow=\"false\""), HasSubstr("data-clipped=\"false\"")));

    ASSERT_EQ(browse(dir, "phone.html", 500, "--dump-dom >" + (dir / "phone.dom")), 0);
    EXPECT_THAT(test::readBytes(dir / "phone.dom"), HasSubstr("data-result=\"390 false\""));
    EXPECT_THAT(test::readBytes(dir / "phone.dom"), HasSubstr("data-readable=\"true\""))
        << "labels are smaller than they are meant to be";

    ASSERT_EQ(browse(dir, "index.html", 1300, "--screenshot=" + (dir / "desk.png")), 0);
    EXPECT_GT(test::readBytes(dir / "desk.png").size(), 50000u);  // an empty page has some 10 kB
    ASSERT_EQ(browse(dir, "index.html", 1300, "--print-to-pdf=" + (dir / "paper.pdf")), 0);
    EXPECT_THAT(test::readBytes(dir / "paper.pdf"), testing::StartsWith("%PDF"));
}

TEST(ReportInBrowser, theFirstPageOnPaperIsNotEmpty)
{
    if (std::system(
            "command -v chromium >/dev/null 2>&1 && command -v pdftotext >/dev/null 2>&1") != 0)
    {
        GTEST_SKIP() << "no chromium, or no pdftotext";
    }
    test::TempDir dir;
    const Trajectory truth = randomTrajectory(300, 1), estimate = odometry(truth, 2);
    HtmlReport report("Comparison", std::string(400, '-'));
    report.addTable("scores", {"run", "mm"}, {{"a", "1"}, {"b", "2"}});
    const AteResult ate = absoluteTrajectoryError(truth, estimate, {});
    for (const Chart& chart : pathCharts(truth, {{"estimate", estimate, ate}}))
    {
        report.addChart(chart);
    }
    RpeOptions options;
    options.fixedDelta = true;
    for (const Chart& chart :
         relativeErrorCharts(estimate, options, relativePoseError(truth, estimate, options)))
    {
        report.addChart(chart);
    }
    (void)writeFile(dir, "index.html", report.html());
    ASSERT_EQ(browse(dir, "index.html", 1300, "--print-to-pdf=" + (dir / "paper.pdf")), 0);
    const std::string toText = "pdftotext -l 1 " + (dir / "paper.pdf") + " " + (dir / "page.txt");
    ASSERT_EQ(std::system(toText.c_str()), 0);
    EXPECT_THAT(test::readBytes(dir / "page.txt"), HasSubstr("scores"));
}
