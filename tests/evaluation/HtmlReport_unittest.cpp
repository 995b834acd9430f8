// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/HtmlReport.h>
#include <pointplane/evaluation/trajectory_charts.h>

#include <cmath>
#include <limits>

#include "test_trajectories.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

using namespace pointplane;
using testing::HasSubstr;
using testing::Not;

namespace
{
/** The charts as the page's script gets them. */
nlohmann::json chartsOf(const std::string& html)
{
    const std::string begin = "const charts = ";
    const std::size_t at = html.rfind(begin) + begin.size();
    return nlohmann::json::parse(html.substr(at, html.find("];\n", at) + 1 - at));
}
}  // namespace

TEST(HtmlReport, isOneSelfContainedFile)
{
    HtmlReport report("a <title>", "sub & title");
    report.addParagraph("5 < 6");
    report.addTable("scores", {"", "rmse"}, {{"translation", "0.1"}});
    Chart chart;
    chart.title = "errors";
    chart.series.push_back({"</script>", {0, 1}, {2, 3}});
    report.addChart(chart);
    const std::string html = report.html();
    EXPECT_THAT(html, HasSubstr("a &lt;title&gt;"));
    EXPECT_THAT(html, HasSubstr("5 &lt; 6"));
    EXPECT_THAT(html, HasSubstr("width=device-width"));
    EXPECT_THAT(html, HasSubstr("Chart.js v"));  // with its licence line
    EXPECT_THAT(html, Not(HasSubstr("<script src")));
    EXPECT_THAT(html, Not(HasSubstr("<link")));
    EXPECT_THAT(html, Not(HasSubstr("@import")));
    EXPECT_EQ(chartsOf(html)[0]["series"][0]["name"], "</script>");
    std::size_t ends = 0;
    for (std::size_t p = 0; (p = html.find("</script>", p)) != std::string::npos; ++p)
    {
        ++ends;
    }
    EXPECT_EQ(ends, 2u);  // a name cannot end a script
}

TEST(HtmlReport, thinsLongSeriesButKeepsExtremesAndGaps)
{
    ChartSeries series;
    for (int k = 0; k < 100000; ++k)
    {
        series.x.push_back(k);
        series.y.push_back(std::sin(0.001 * k));
    }
    series.y[54321] = 77;
    series.y[12345] = -77;
    Chart chart;
    chart.series.push_back(series);
    chart.series.push_back({"gap", {0, 1, 2}, {1, std::numeric_limits<double>::quiet_NaN(), 2}});
    HtmlReport report("t", "s");
    report.addChart(chart);
    const auto json = chartsOf(report.html());
    const std::vector<double> y = json[0]["series"][0]["y"];
    EXPECT_LE(y.size(), 3100u);
    EXPECT_EQ(*std::max_element(y.begin(), y.end()), 77);
    EXPECT_EQ(*std::min_element(y.begin(), y.end()), -77);
    EXPECT_EQ(json[0]["series"][0]["x"].back(), 99999);
    EXPECT_TRUE(json[0]["series"][1]["y"][1].is_null());
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

    const std::vector<Chart> charts = frameCharts(table);
    ASSERT_EQ(charts.size(), 2u);  // no times in this table
    EXPECT_EQ(charts[1].series[0].y, (std::vector<double>{2, 0}));
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
    EXPECT_THAT(messageOf(dir / "none.csv"), HasSubstr("none.csv"));
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
    const std::vector<Chart> paths = pathCharts(truth, estimate, ate);
    ASSERT_EQ(paths.size(), 2u);
    ASSERT_EQ(paths[1].series.size(), 3u);  // truth, estimate, ellipses
    EXPECT_EQ(paths[1].series[0].y[7], truth.poses[7].translation().z());
    EXPECT_TRUE(paths[0].equalScales);

    RpeOptions options;
    options.fixedDelta = true;
    const RpeResult rpe = relativePoseError(truth, estimate, options);
    const Chart errors = relativeErrorChart(estimate, options, rpe);
    EXPECT_EQ(errors.series[0].x.size(), rpe.pairs.size());
    EXPECT_EQ(errors.series[0].y[3], 1000 * rpe.pairs[3].translation);

    const auto increments = neesIncrements(truth, estimate, {}, {});
    const Chart nees = neesChart(estimate, increments, consistencyOf(increments, 59, {}));
    EXPECT_EQ(nees.series[0].y[5], increments[5].nees / 6);

    const auto sigmas = errorAgainstSigmaCharts(estimate, increments);
    ASSERT_EQ(sigmas.size(), 2u);  // translation, rotation
    for (int k = 0; k < 6; ++k)
    {
        const ChartSeries& axis = sigmas[k / 3].series[k % 3];
        EXPECT_EQ(axis.x[5], estimate.stamps[increments[5].i] - estimate.stamps[0]);
        EXPECT_EQ(axis.y[5], increments[5].error[k] / std::sqrt(increments[5].cov(k, k)));
    }
    EXPECT_THAT(sigmas[1].series[3].y, testing::Contains(3.0));  // the level of 3 sigma
}
