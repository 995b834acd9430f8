// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/odometry/Odometry.h>
#include <pointplane/simulation/SimulatedSequence.h>

#include <opencv2/core.hpp>

#include <cstdio>
#include <exception>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "markdown_section.h"

/** Is what moves called moving? Simulated scenes with exact masks, as a Markdown table. */
namespace pointplane
{
namespace
{
/** Counts of pixels' cells and of points. */
struct Score
{
    int cells{0}, cellsRight{0};                  //!< called moving; of these, on a mover
    int pixels{0}, onMovers{0}, calledMoving{0};  //!< with depth; on movers; of these, in cells
    int stillPoints{0}, stillUsed{0};             //!< found again; of these, the pose follows them
    int movingPoints{0}, movingUsed{0};           //!< the same of points on movers

    void add(const RgbdFrame& frame, const cv::Mat& labels, const FrameFeatures& features);
    [[nodiscard]] std::string row() const;
};

/** Any label in the cell: its edges are half of it. */
bool touchesMover(const cv::Mat& labels, const cv::Rect& cell)
{
    return cv::countNonZero(labels(cell)) > 0;
}

void Score::add(const RgbdFrame& frame, const cv::Mat& labels, const FrameFeatures& features)
{
    cv::Mat called(labels.size(), CV_8UC1, cv::Scalar(0));
    for (const cv::Rect& cell : features.moving.cells)
    {
        called(cell) = 1;
        ++cells;
        cellsRight += touchesMover(labels, cell);
    }
    const cv::Mat hasDepth = frame.depth > 0, moves = hasDepth & (labels > 0);
    pixels += cv::countNonZero(hasDepth);
    onMovers += cv::countNonZero(moves);
    calledMoving += cv::countNonZero(moves & (called > 0));
    for (const FrameFeatures::Point& point : features.points)
    {
        const cv::Point pixel(cvRound(point.uv_px.x()), cvRound(point.uv_px.y()));
        if (point.use == FeatureUse::New || !cv::Rect({}, labels.size()).contains(pixel))
        {
            continue;
        }
        const bool isOnMover = labels.at<std::uint8_t>(pixel) > 0;
        const bool isUsed = point.use == FeatureUse::Used;
        movingPoints += isOnMover;
        movingUsed += isOnMover && isUsed;
        stillPoints += !isOnMover;
        stillUsed += !isOnMover && isUsed;
    }
}

std::string percent(int part, int whole)
{
    return whole > 0 ? std::to_string(static_cast<int>(100.0 * part / whole + 0.5)) : "-";
}

std::string Score::row() const
{
    return percent(onMovers, pixels) + " | " + percent(cellsRight, cells) + " | " +
           percent(calledMoving, onMovers) + " | " + percent(movingUsed, movingPoints) + " | " +
           percent(stillUsed, stillPoints);
}

struct Motion
{
    const char* name;
    double scale, speed;
};

Score scoreOf(const std::string& scene, const Motion& motion)
{
    SimulationParams params;
    params.duration = 2;
    params.motionScale = motion.scale;
    params.motionSpeed = motion.speed;
    const SimulatedSequence sequence(scene, params, 1);
    Odometry odometry{OdometryParams()};
    Score score;
    for (int i = 0; i < sequence.numFrames(); ++i)
    {
        const RgbdFrame frame = sequence.frame(i);
        if (odometry.process(frame).status == TrackingStatus::Tracked)
        {
            score.add(frame, sequence.trueMovers(i).labels, odometry.features());
        }
    }
    return score;
}

std::string table()
{
    std::ostringstream out;
    out << "\n| scene | camera | view that moves [%] | precision [%] | recall [%] | points on "
           "movers "
           "that count [%] | still points that count [%] |\n|---|---|---|---|---|---|---|\n";
    for (const char* scene : {"person", "push", "door", "half", "seated"})
    {
        for (const Motion& motion : {Motion{"hand", 1, 1}, Motion{"stands", 1, 0}, {"fast", 1, 3}})
        {
            std::cerr << scene << ", " << motion.name << "\n";
            out << "| " << scene << " | " << motion.name << " | " << scoreOf(scene, motion).row()
                << " |\n";
        }
    }
    out << "\n";
    return out.str();
}
}  // namespace
}  // namespace pointplane

int main(int argc, char** argv)
{
    try
    {
        if (argc > 2)
        {
            std::cerr << "usage: benchmark_movers [PAGE.md with movers:begin and movers:end]\n";
            return 2;
        }
        if (argc == 2)
        {
            pointplane::checkMarkdownSection(argv[1], "movers");
        }
        const std::string table = pointplane::table();
        std::cout << table;
        if (argc == 2)
        {
            pointplane::replaceMarkdownSection(argv[1], "movers", table);
        }
        return 0;
    }
    catch (const std::exception& e)
    {
        std::cerr << "benchmark_movers: " << e.what() << "\n";
        return 2;
    }
}
