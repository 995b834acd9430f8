// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/HtmlReport.h>
#include <pointplane/evaluation/trajectory_charts.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "test_trajectories.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

using namespace pointplane;
using testing::HasSubstr;
using testing::Not;

TEST(HtmlReport, isOneSelfContainedFile)
{
    HtmlReport report("a <title>", "sub & title");
    report.addParagraph("5 < 6");
    report.addTable("scores", {"", "rmse"}, {{"translation", "0.1"}}, "of 2 < 3 pairs");
    Chart chart;
    chart.title = "errors";
    chart.series.push_back({"</script>", {0, 1}, {2, 3}});
    report.addChart(chart);
    const std::string html = report.html();
    EXPECT_THAT(html, HasSubstr("a &lt;title&gt;"));
    EXPECT_THAT(html, HasSubstr("5 &lt; 6"));
    EXPECT_THAT(html, HasSubstr("<h2>scores</h2><p class=\"detail\">of 2 &lt; 3 pairs</p>"));
    EXPECT_THAT(html, HasSubstr("<td class=\"text\">translation</td><td>0.1</td>"));
    EXPECT_THAT(html, HasSubstr("width=device-width"));
    EXPECT_THAT(html, HasSubstr("<svg"));
    EXPECT_THAT(html, Not(HasSubstr("<script src")));
    EXPECT_THAT(html, Not(HasSubstr("<link")));
    EXPECT_THAT(html, Not(HasSubstr("@import")));
    EXPECT_THAT(html, HasSubstr(">&lt;/script&gt;</text>"));
    std::size_t ends = 0;
    for (std::size_t p = 0; (p = html.find("</script>", p)) != std::string::npos; ++p)
    {
        ++ends;
    }
    EXPECT_EQ(ends, 1u);  // a name cannot end a script
}

TEST(HtmlReport, foldsDetailsAway)
{
    HtmlReport report("t", "s");
    report.addDetails("configuration", "[Section]\nkey = <1>\n");
    EXPECT_THAT(report.html(), HasSubstr("<summary>configuration</summary>"));
    EXPECT_THAT(report.html(), HasSubstr("key = &lt;1&gt;\n"));
}

TEST(HtmlReport, embedsPictures)
{
    test::TempDir dir;
    HtmlReport report("t", "s");
    report.addPicture("picture", writeFile(dir, "p.png", "\x89PNG1"));  // 5 bytes: padding
    EXPECT_THAT(report.html(), HasSubstr("src=\"data:image/png;base64,iVBORzE=\""));
    EXPECT_THROW(report.addPicture("none", dir / "none.png"), std::runtime_error);
}

TEST(FrameTable, readsNumbersStatusAndQuotes)
{
    test::TempDir dir;
    const FrameTable table = FrameTable::read(writeFile(
        dir,
        "f.csv",
        "frame,stamp,status,reason,numPoints\n"
        "0,10.5,first,\"\",7\n"
        "1,11.5,lost,\"no depth, \"\"really\"\"\",nan\n"));
    ASSERT_EQ(table.size(), 2u);
    EXPECT_EQ(table.stamps()[1], 11.5);
    EXPECT_EQ(table.status()[1], "lost");
    EXPECT_EQ(table.column("numPoints")[0], 7);
    EXPECT_TRUE(std::isnan(table.column("numPoints")[1]));
    EXPECT_TRUE(table.column("msTotal").empty());
    EXPECT_EQ(splitCsvLine("a,\"b \"\"c\"\", d\",")[1], "b \"c\", d");
    EXPECT_EQ(splitCsvLine("a,\"b\",").size(), 3u);

    const std::vector<Chart> charts = frameCharts(table, 8);
    ASSERT_EQ(charts.size(), 2u);  // no times in this table
    EXPECT_EQ(charts[1].series[0].y, (std::vector<double>{2, 0}));
    EXPECT_EQ(charts[1].series[0].x, (std::vector<double>{2.5, 3.5}));
}

TEST(FrameTable, tellsFramesThatAreMeasuredInPart)
{
    test::TempDir dir;
    const std::string rows = "0,first,0\n1,tracked,6\n2,tracked,4\n3,predicted,0\n4,lost,0\n";
    const Chart status = frameCharts(
        FrameTable::read(writeFile(dir, "f.csv", "stamp,status,observableDirections\n" + rows)),
        0)[0];
    EXPECT_EQ(status.yNames, (std::vector<std::string>{"lost", "predicted", "in part", "tracked"}));
    EXPECT_EQ(status.series[0].y, (std::vector<double>{3, 3, 2, 1, 0}));
}

/** As a spreadsheet saves it. */
TEST(FrameTable, readsBehindAByteOrderMarkAndLinesWithoutFields)
{
    test::TempDir dir;
    const FrameTable table = FrameTable::read(writeFile(
        dir,
        "f.csv",
        "\xEF\xBB\xBF"
        "frame,stamp\r\n7,10.5\r\n\r\n"));
    ASSERT_EQ(table.size(), 1u);
    EXPECT_EQ(table.column("frame"), std::vector<double>{7});
}

/** Of two frames lost for a late stamp, one has that of a pose. */
TEST(FrameTable, rowsAreFoundByStampsAndOnlyTheirOwn)
{
    test::TempDir dir;
    const FrameTable table = FrameTable::read(writeFile(
        dir,
        "f.csv",
        "frame,stamp,status\n7,10.0,first\n8,10.1,tracked\n9,9.9,lost\n10,10.0,lost\n"
        "11,10.2,tracked\n12,10.3,tracked\n13,10.4,lost\n"));
    using Rows = std::vector<std::pair<std::size_t, std::size_t>>;
    EXPECT_EQ(rowsOf({10, 10.2000004, 10.34}, table), (Rows{{0, 0}, {1, 4}, {2, 5}}));
    EXPECT_EQ(rowsOf({9, 9.84, 9.9, 10.4, 1e9}, table), Rows{});
    EXPECT_EQ(rowsOf({1}, FrameTable()), Rows{});
}

TEST(FrameTable, namesFileAndLineOfMalformedInput)
{
    test::TempDir dir;
    const auto messageOf = [](const std::string& path) -> std::string
    {
        try
        {
            (void)FrameTable::read(path);
        }
        catch (const std::runtime_error& e)
        {
            return e.what();
        }
        return "no exception";
    };
    EXPECT_THAT(messageOf(dir / "none.csv"), HasSubstr("none.csv: No such file or directory"));
    EXPECT_THAT(messageOf(dir / ""), HasSubstr(": is a directory"));
    EXPECT_THAT(messageOf(writeFile(dir, "e.csv", "")), HasSubstr("e.csv: is empty, not a table"));
    EXPECT_THAT(messageOf(writeFile(dir, "a.csv", "x,y\n")), HasSubstr("a.csv:1: no column"));
    EXPECT_THAT(messageOf(writeFile(dir, "b.csv", "stamp,y\n1,2\n3\n")), HasSubstr("b.csv:3: 1 f"));
    EXPECT_THAT(messageOf(writeFile(dir, "c.csv", "stamp,y\nq,2\n")), HasSubstr("c.csv:2: the st"));
}

TEST(TrajectoryCharts, ellipseIsThreeSigmaOfThePosition)
{
    // At 2 m from the origin along x, a yaw of 0.1 rad moves the position along y by 0.2 m.
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() << 2, 0, 0;
    Matrix6d cov = Matrix6d::Zero();
    cov(0, 0) = 0.01 * 0.01;
    cov(5, 5) = 0.1 * 0.1;
    double xMax = 0;
    double yMax = 0;
    for (const Eigen::Vector2d& p : positionEllipse(T, cov, 0, 1, 361))
    {
        xMax = std::max(xMax, p.x());
        yMax = std::max(yMax, p.y());
    }
    EXPECT_NEAR(xMax, 2 + 3 * 0.01, 1e-6);
    EXPECT_NEAR(yMax, 3 * 0.2, 1e-6);
}

TEST(TrajectoryCharts, showWhatTheyAreGiven)
{
    const Trajectory truth = randomTrajectory(60, 1);
    const Trajectory estimate = odometry(truth, 2);
    const AteResult ate = absoluteTrajectoryError(truth, estimate, {});
    const std::vector<Chart> paths = pathCharts(truth, {{"estimate", estimate, ate}});
    ASSERT_EQ(paths.size(), 2u);
    std::vector<std::string> names;
    for (const ChartSeries& series : paths[1].series)
    {
        names.push_back(series.name);
    }
    // The ground truth is drawn after the estimate, so that it is seen.
    EXPECT_THAT(names, testing::ElementsAre("estimate", "3 sigma", "ground truth", "start", "end"));
    EXPECT_EQ(paths[1].series[2].y[7], truth.poses[7].translation().z());
    EXPECT_EQ(paths[1].series[0].level[7], 1000 * ate.errors[7].translation);
    EXPECT_EQ(paths[1].series[4].y[0], truth.poses[59].translation().z());
    EXPECT_TRUE(paths[0].equalScales);
    EXPECT_EQ(pathCharts(truth, {{"a", estimate, ate}, {"b", estimate, ate}})[0].series.size(), 5u);

    RpeOptions options;
    options.fixedDelta = true;
    const RpeResult rpe = relativePoseError(truth, estimate, options);
    const std::vector<Chart> errors = relativeErrorCharts(estimate, options, rpe);
    EXPECT_EQ(errors[0].title, "Relative error over 1 s: translation");
    EXPECT_EQ(errors[0].series[0].x.size(), rpe.pairs.size());
    EXPECT_EQ(errors[0].series[0].y[3], 1000 * rpe.pairs[3].translation);

    const Chart histogram = errorHistograms(options, rpe)[0];
    double pairs = 0;
    for (const double bar : histogram.series[0].y)
    {
        pairs += bar;
    }
    EXPECT_EQ(pairs, rpe.pairs.size());
    EXPECT_EQ(histogram.series[1].y.back(), 100);
    EXPECT_NEAR(histogram.series[1].x.back(), 1000 * rpe.translation.max, 1e-9);

    const Chart over = errorOverInterval(truth, estimate, options)[0];
    const ChartSeries& rmse = over.series[0];
    const auto oneSecond = std::find(rmse.x.begin(), rmse.x.end(), 1.0) - rmse.x.begin();
    EXPECT_EQ(rmse.y[static_cast<std::size_t>(oneSecond)], 1000 * rpe.translation.rmse);
    EXPECT_EQ(rmse.x.back(), 2.0);  // the trajectory has 5.9 s

    const auto increments = neesIncrements(truth, estimate, {}, {});
    const Chart nees = neesChart(estimate, increments, consistencyOf(increments, 59, {}));
    EXPECT_EQ(nees.series[0].y[5], increments[5].nees / 6);

    const auto sigmas = errorAgainstSigmaCharts(estimate, increments, {});
    ASSERT_EQ(sigmas.size(), 2u);  // translation, rotation
    for (int k = 0; k < 6; ++k)
    {
        const ChartSeries& axis = sigmas[k / 3].series[k % 3];
        EXPECT_EQ(axis.x[5], estimate.stamps[increments[5].j] - estimate.stamps[0]);
        EXPECT_EQ(axis.y[5], increments[5].error[k] / std::sqrt(increments[5].cov(k, k)));
    }
    EXPECT_THAT(sigmas[1].series[3].y, testing::Contains(3.0));  // the level of 3 sigma
}

TEST(TrajectoryCharts, posesBesideTheTruthHaveTheirSigmas)
{
    const Trajectory truth = randomTrajectory(60, 1);
    const Trajectory estimate = odometry(truth, 2);
    AteOptions options;
    options.alignment = Alignment::FirstPose;
    const AteResult aligned = absoluteTrajectoryError(truth, estimate, options);
    const std::vector<Chart> charts = poseCharts(truth, estimate, options, aligned);
    ASSERT_EQ(charts.size(), 12u);
    EXPECT_EQ(charts[1].title, "y");
    EXPECT_EQ(charts[4].title, "Error of y");
    EXPECT_EQ(charts[6].title, "roll");
    EXPECT_EQ(charts[11].title, "Rotation error about z");
    // An error is estimate less truth, in mm; the first pose is aligned.
    const ChartSeries& band = charts[4].series[0];
    const ChartSeries& error = charts[4].series[1];
    EXPECT_NEAR(error.y[0], 0, 1e-9);
    EXPECT_NEAR(error.y[30], 1000 * (charts[1].series[1].y[30] - charts[1].series[2].y[30]), 1e-6);
    // The band is that of the ellipses on the map.
    double yMax = 0;
    const Matrix6d Ad = adjoint(aligned.T_truth_estimate);
    const Eigen::Isometry3d T = aligned.T_truth_estimate * estimate.poses[30];
    for (const Eigen::Vector2d& p :
         positionEllipse(T, Ad * estimate.covs[30] * Ad.transpose(), 0, 1, 3601))
    {
        yMax = std::max(yMax, p.y() - T.translation().y());
    }
    EXPECT_NEAR(band.yUpper[30], 1000 * yMax, 1e-3 * 1000 * yMax);
    Trajectory withoutCovs = estimate;
    withoutCovs.covs.clear();
    EXPECT_EQ(poseCharts(truth, withoutCovs, options, aligned)[4].series.size(), 1u);
}

namespace
{
std::size_t holesIn(const ChartSeries& series)
{
    return static_cast<std::size_t>(std::count_if(
        series.y.begin(), series.y.end(), [](double y) { return !std::isfinite(y); }));
}
}  // namespace

/** Nobody measured the way through them; that of the ground truth is known. */
TEST(TrajectoryCharts, linesEndAtLostFramesButThoseOfTheTruthDoNot)
{
    const Trajectory truth = randomTrajectory(120, 1, 0.05);
    Trajectory marked = odometry(truth, 2);
    marked.status.assign(120, FrameStatus::Tracked);
    std::fill(marked.status.begin() + 40, marked.status.begin() + 80, FrameStatus::Lost);
    marked.status[100] = FrameStatus::Lost;
    const Trajectory estimate = withoutLost(marked);
    const AteResult ate = absoluteTrajectoryError(truth, estimate, {});

    const std::vector<ChartSeries> path = pathCharts(truth, {{"one", estimate, ate}})[0].series;
    EXPECT_EQ(path[2].name, "ground truth");
    EXPECT_EQ(path[2].y.size(), 120U);
    EXPECT_EQ(path[2].y[60], truth.poses[60].translation().y());
    EXPECT_EQ(holesIn(path[2]), 0U);
    for (const ChartSeries& series :
         {path[0],
          pathCharts(truth, {{"a", estimate, ate}, {"b", estimate, ate}})[1].series[1],
          positionErrorChart(estimate, ate).series[0]})
    {
        EXPECT_EQ(series.y.size(), 79U + 2U) << series.name;
        EXPECT_TRUE(std::isnan(series.y[40])) << series.name;
        EXPECT_TRUE(std::isnan(series.y[61])) << series.name;
    }
    const std::vector<Chart> poses = poseCharts(truth, estimate, {}, ate);
    const ChartSeries& band = poses[1].series[0];
    EXPECT_TRUE(std::isnan(band.y[40]) && std::isnan(band.yUpper[61]));
    EXPECT_EQ(holesIn(poses[1].series[1]), 2U);
    EXPECT_EQ(holesIn(poses[4].series[1]), 2U);
    EXPECT_EQ(poses[1].series[2].name, "ground truth");
    EXPECT_EQ(poses[1].series[2].y.size(), 120U);
    EXPECT_EQ(poses[1].series[2].y[60], truth.poses[60].translation().y());
    EXPECT_EQ(holesIn(poses[1].series[2]), 0U);

    RpeOptions options;
    options.fixedDelta = true;
    const RpeResult rpe = relativePoseError(truth, estimate, options);
    EXPECT_EQ(holesIn(relativeErrorCharts(estimate, options, rpe)[0].series[0]), 1U);
}

/** The estimate goes on where nobody knows how wrong it is. */
TEST(TrajectoryCharts, linesEndWhereTheTruthDoes)
{
    const Trajectory whole = randomTrajectory(120, 1);
    const Trajectory estimate = odometry(whole, 2);
    Trajectory truth = withHole(whole, 90, 120);
    truth = withHole(truth, 30, 60);
    const AteResult ate = absoluteTrajectoryError(truth, estimate, {});
    RpeOptions options;
    options.fixedDelta = true;
    const RpeResult rpe = relativePoseError(truth, estimate, options);
    EXPECT_EQ(holesIn(relativeErrorCharts(estimate, options, rpe)[0].series[0]), 1U);
    EXPECT_EQ(holesIn(positionErrorChart(estimate, ate).series[0]), 1U);

    const std::vector<ChartSeries> one = pathCharts(truth, {{"a", estimate, ate}})[0].series;
    EXPECT_EQ(one[0].y.size(), 60U + 1U);
    EXPECT_TRUE(std::isnan(one[0].y[30]));
    EXPECT_EQ(one[1].name, "no ground truth");
    EXPECT_EQ(one[1].style, ChartSeries::Style::Dashed);
    EXPECT_EQ(one[1].y.size(), 32U + 1U + 31U);  // with the poses that it joins
    EXPECT_TRUE(std::isnan(one[1].y[32]));
    EXPECT_EQ(one[1].y[0], one[0].y[29]);
    EXPECT_EQ(one[1].y[33], one[0].y.back());

    const std::vector<ChartSeries> two =
        pathCharts(truth, {{"a", estimate, ate}, {"b", estimate, ate}})[0].series;
    ASSERT_EQ(two.size(), 7U);
    EXPECT_EQ(two[2].name, "no ground truth");
    EXPECT_EQ(two[2].colour, "c0");
    EXPECT_EQ(two[3].name, "");
    EXPECT_EQ(two[3].colour, "c1");
}

/** Frames every half second have no pairs of 0.7 s. */
TEST(TrajectoryCharts, lengthsThatNoPairHasAreNotJoined)
{
    const Trajectory truth = randomTrajectory(60, 1, 0.5);
    const ChartSeries rmse = errorOverInterval(truth, odometry(truth, 2), {})[0].series[0];
    EXPECT_EQ(rmse.x, (std::vector<double>{0.5, 0.5, 1, 1.5, 2, 3, 4, 5}));
    EXPECT_TRUE(std::isnan(rmse.y[1]));
    EXPECT_EQ(holesIn(rmse), 1U);
}

/** It may turn on while the estimate is lost. */
TEST(TrajectoryCharts, anglesGoOnAsThoseOfTheTruth)
{
    std::vector<StampedPose> turning;
    for (int k = 0; k < 200; ++k)
    {
        Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
        T.linear() = so3Exp({0, 0, 0.05 * k});
        T.translation().x() = 0.01 * k;
        turning.push_back({0.1 * k, T, {}});
    }
    const Trajectory truth = makeTrajectory("truth", turning);
    turning.erase(turning.begin() + 10, turning.begin() + 190);
    const Trajectory estimate = makeTrajectory("estimate", turning);
    const AteResult ate = absoluteTrajectoryError(truth, estimate, {});
    const Chart yaw = poseCharts(truth, estimate, {}, ate)[8];
    EXPECT_EQ(yaw.title, "yaw");
    EXPECT_NEAR(yaw.series[0].y.back(), 0.05 * 199 * 180 / M_PI, 1e-6);
    EXPECT_NEAR(yaw.series[1].y.back(), 0.05 * 199 * 180 / M_PI, 1e-6);
}
