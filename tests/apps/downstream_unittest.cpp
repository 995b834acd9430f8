// SPDX-License-Identifier: BSD-3-Clause
// Runs the installed MRPT programs on what pointplane-odometry writes; docs/downstream.md shows the
// same commands.
#include <pointplane/core/se3.h>
#include <pointplane/mrpt_io/RawlogReader.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <mrpt/graphs/CNetworkOfPoses.h>
#include <mrpt/graphslam/levmarq.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <Eigen/Cholesky>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "OdometryApp.h"
#include "SimulateApp.h"
#include "TempDir.h"
#include "linear_algebra.h"
#include "map_sinks.h"
#include "monte_carlo.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
using test::readBytes;
using test::TempDir;
using test::writeBytes;

[[nodiscard]] bool isInstalled(const std::string& program)
{
    return std::system(("command -v " + program + " > /dev/null 2>&1").c_str()) == 0;
}

/** One simulated second of a room corner and everything that is written from it, made once. */
class Downstream : public testing::Test
{
 protected:
    static constexpr int kFrames = 13;

    static void SetUpTestSuite()
    {
        dir_ = std::make_unique<TempDir>();
        std::ostringstream log;
        ASSERT_EQ(
            runSimulate(
                {"corner",
                 "-o",
                 path("in.rawlog"),
                 "--size",
                 "160x120",
                 "--fps",
                 "6",
                 "--duration",
                 "2",
                 "--seed",
                 "3",
                 "--ideal",
                 "--quiet"},
                log,
                log),
            0)
            << log.str();
        ASSERT_EQ(
            runOdometry(
                {path("in.rawlog"),
                 "--quiet",
                 "-o",
                 path("format1.rawlog"),
                 "--format1",
                 "--with-points",
                 "--simplemap",
                 path("vo.simplemap"),
                 "--keyframe-distance",
                 "0.03",
                 "--graph",
                 path("vo.graph"),
                 "--trajectory",
                 path("robot.txt"),
                 "--trajectory-frame",
                 "robot"},
                log,
                log),
            0)
            << log.str();
        ASSERT_EQ(
            runOdometry(
                {path("in.rawlog"), "--quiet", "-o", path("format2.rawlog"), "--only-poses"},
                log,
                log),
            0)
            << log.str();
    }
    static void TearDownTestSuite() { dir_.reset(); }

    [[nodiscard]] static std::string path(const std::string& name) { return *dir_ / name; }

    /** Runs a command in the folder; its output in `log`. */
    [[nodiscard]] static int run(const std::string& command, std::string* log = nullptr)
    {
        const int status = std::system(
            ("cd " + path("") + " && echo | timeout 120 " + command + " > log.txt 2>&1").c_str());
        if (log != nullptr)
        {
            *log = readBytes(path("log.txt"));
        }
        return status;
    }

    /** x, y, z of the last line of numbers in a text file, from column `first`. */
    [[nodiscard]] static Eigen::Vector3d lastPosition(const std::string& name, int first)
    {
        std::ifstream file(path(name));
        std::string line, last;
        while (std::getline(file, line))
        {
            last = line.empty() || line[0] == '#' || line[0] == '%' ? last : line;
        }
        std::istringstream words(last);
        std::string skipped;
        for (int i = 0; i < first; ++i)
        {
            words >> skipped;
        }
        Eigen::Vector3d out;
        words >> out.x() >> out.y() >> out.z();
        return out;
    }

    static std::unique_ptr<TempDir> dir_;
};
std::unique_ptr<TempDir> Downstream::dir_;

TEST_F(Downstream, format1HoldsActionsWithCovariancesAndFrames)
{
    RawlogReader reader(path("format1.rawlog"));
    PoseGaussian composed;
    int numFrames = 0;
    while (const auto object = reader.next())
    {
        const auto actions = std::dynamic_pointer_cast<mrpt::obs::CActionCollection>(object);
        ASSERT_TRUE(actions);
        const auto movement = actions->getActionByClass<mrpt::obs::CActionRobotMovement3D>();
        ASSERT_TRUE(movement);
        EXPECT_EQ(movement->estimationMethod, mrpt::obs::CActionRobotMovement3D::emVisualOdometry);
        const PoseGaussian increment = fromMrpt(movement->poseChange);
        EXPECT_TRUE(test::hasCholesky(increment.cov));
        composed = compose(composed, increment);
        const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(reader.next());
        ASSERT_TRUE(frame);
        const auto pose = frame->getObservationByClass<mrpt::obs::CObservationRobotPose>();
        ASSERT_TRUE(pose);
        EXPECT_LT(
            (fromMrpt(pose->pose.mean).translation() - composed.mean.translation()).norm(), 1e-6);
        const auto scan = frame->getObservationByClass<mrpt::obs::CObservation3DRangeScan>();
        ASSERT_TRUE(scan);
        EXPECT_TRUE(scan->hasPoints3D);
        ++numFrames;
    }
    EXPECT_EQ(reader.ending().kind, RawlogEnd::Clean);
    EXPECT_EQ(numFrames, kFrames);
    EXPECT_GT(composed.mean.translation().norm(), 0.02);
}

TEST_F(Downstream, onlyPosesIsSmall)
{
    RawlogReader reader(path("format2.rawlog"));
    int numPoses = 0;
    while (const auto object = reader.next())
    {
        EXPECT_FALSE(std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(object));
        numPoses += std::dynamic_pointer_cast<mrpt::obs::CObservationRobotPose>(object) ? 1 : 0;
    }
    EXPECT_EQ(numPoses, kFrames);
    EXPECT_LT(std::filesystem::file_size(path("format2.rawlog")), 1000U * kFrames);
}

TEST_F(Downstream, graphslamEngineTakesTheActions)
{
    const std::string config = "/usr/share/mrpt/config_files/graphslam-engine/odometry_3d_slam.ini";
    if (!isInstalled("graphslam-engine") || !std::filesystem::exists(config))
    {
        GTEST_SKIP() << "graphslam-engine is not installed (packages mrpt-apps, mrpt-common)";
    }
    std::string ini = readBytes(config);
    const std::string general = "[GeneralConfiguration]\n";
    ini.insert(ini.find(general) + general.size(), "save_map = false\n");
    const std::string distance = "\nregistration_max_distance = 0.2";
    ini.replace(ini.find(distance), distance.size(), "\nregistration_max_distance = 0.01");
    writeBytes(path("gse.ini"), ini);
    std::string log;
    ASSERT_EQ(
        run("graphslam-engine --3d --disable-visuals -i gse.ini -r format1.rawlog "
            "-n CFixedIntervalsNRD -e CEmptyERD -o CLevMarqGSO",
            &log),
        0)
        << log;
    // Its last node is our pose, as far as its registration distance goes.
    mrpt::graphs::CNetworkOfPoses3DInf graph;
    graph.loadFromTextFile(path("graphslam_results/output_graph.graph"));
    ASSERT_GT(graph.nodes.size(), 3U);
    const Eigen::Vector3d last = fromMrpt(graph.nodes.rbegin()->second).translation();
    EXPECT_LT((last - lastPosition("robot.txt", 1)).norm(), 0.02);
    for (const auto& [ids, edge] : graph.edges)
    {
        EXPECT_TRUE(test::hasCholesky(edge.cov_inv.asEigen()));
    }
}

TEST_F(Downstream, rbpfSlamFollowsTheOdometry)
{
    if (!isInstalled("rbpf-slam"))
    {
        GTEST_SKIP() << "rbpf-slam is not installed (package mrpt-apps)";
    }
    writeBytes(path("rbpf.ini"), readBytes(POINTPLANE_SOURCE_DIR "/docs/rbpf.ini"));
    std::string log;
    ASSERT_EQ(run("rbpf-slam rbpf.ini format1.rawlog", &log), 0) << log;
    const Eigen::Vector3d last = lastPosition("rbpf_results/log_odometry_path.txt", 1);
    EXPECT_LT((last - lastPosition("robot.txt", 1)).norm(), 1e-4);
}

TEST_F(Downstream, simplemapIsReadAndMapped)
{
    mrpt::maps::CSimpleMap map;
    {
        mrpt::io::CFileGZInputStream file(path("vo.simplemap"));
        auto archive = mrpt::serialization::archiveFrom(file);
        archive >> map;
    }
    ASSERT_GE(map.size(), 2U);
    for (const auto& pair : map)
    {
        const auto scan = pair.sf->getObservationByClass<mrpt::obs::CObservation3DRangeScan>();
        ASSERT_TRUE(scan);
        EXPECT_TRUE(scan->hasPoints3D);
        EXPECT_GT(scan->points3D_x.size(), 1000U);
    }
    if (!isInstalled("observations2map"))
    {
        GTEST_SKIP() << "observations2map is not installed (package mrpt-apps)";
    }
    writeBytes(path("o2m.ini"), "[MappingApplication]\npointsMap_count = 1\n");
    std::string log;
    ASSERT_EQ(run("observations2map o2m.ini vo.simplemap map", &log), 0) << log;
    EXPECT_GT(std::filesystem::file_size(path("map_mrpt__maps__CSimplePointsMap_00.txt")), 10000U);
}

TEST_F(Downstream, graphIsReadAndOptimised)
{
    mrpt::graphs::CNetworkOfPoses3DInf graph;
    graph.loadFromTextFile(path("vo.graph"));
    EXPECT_EQ(graph.nodes.size(), static_cast<std::size_t>(kFrames));
    EXPECT_EQ(graph.edges.size(), static_cast<std::size_t>(kFrames - 1));
    if (!isInstalled("graph-slam"))
    {
        GTEST_SKIP() << "graph-slam is not installed (package mrpt-apps)";
    }
    std::string log;
    ASSERT_EQ(run("graph-slam --3d --levmarq -q -i vo.graph -o optimised.graph", &log), 0) << log;
    mrpt::graphs::CNetworkOfPoses3DInf optimised;
    optimised.loadFromTextFile(path("optimised.graph"));
    EXPECT_EQ(optimised.nodes.size(), graph.nodes.size());
}

TEST_F(Downstream, rawlogEditKnowsAndExportsThePoses)
{
    if (!isInstalled("rawlog-edit"))
    {
        GTEST_SKIP() << "rawlog-edit is not installed (package mrpt-apps)";
    }
    std::string log;
    ASSERT_EQ(run("rawlog-edit --info -i format2.rawlog", &log), 0) << log;
    EXPECT_THAT(log, testing::HasSubstr("RGBD_pose"));
    ASSERT_EQ(run("rawlog-edit --export-txt -i format2.rawlog", &log), 0) << log;
    const std::string exported = "format2_RGBD_pose.txt";
    ASSERT_TRUE(std::filesystem::exists(path(exported))) << log;
    EXPECT_LT((lastPosition(exported, 1) - lastPosition("robot.txt", 1)).norm(), 1e-4);  // %.5f
}

using Graph = mrpt::graphs::CNetworkOfPoses3DInf;

/** A robot that drives a square: straights are measured well, turns badly. */
class Loop
{
 public:
    explicit Loop(unsigned seed) : sampler_(seed)
    {
        Eigen::Isometry3d truth = Eigen::Isometry3d::Identity();
        PoseGaussian estimate;
        truth_.push_back(truth);
        for (int i = 0; i < 40; ++i)
        {
            const bool turn = i % 10 == 9;
            Eigen::Isometry3d step = Eigen::Isometry3d::Identity();
            step.translation().x() = 0.5;
            step.linear() = so3Exp(Eigen::Vector3d(0, 0, turn ? M_PI / 2 : 0));
            truth = truth * step;
            truth_.push_back(truth);
            Vector6d sigma;
            sigma << 0.01, 0.01, 0.01, 0.002, 0.002, turn ? 0.1 : 0.002;
            const Matrix6d cov = sigma.cwiseAbs2().asDiagonal();
            increments_.push_back({se3Exp(sampler_.sample(cov)) * step, cov});
        }
    }

    /** Writes the graph with GraphSink and closes the loop. */
    [[nodiscard]] Graph graph(const std::string& path) const
    {
        GraphSink sink(path);
        PoseGaussian pose;
        pose.cov = 1e-10 * Matrix6d::Identity();
        for (std::size_t i = 0; i <= increments_.size(); ++i)
        {
            OutputItem item;
            item.frame.emplace();
            if (i > 0)
            {
                pose = compose(pose, increments_[i - 1]);
                item.frame->motion.increment = toMrpt(increments_[i - 1]);
            }
            item.frame->motion.pose = toMrpt(pose);
            sink.add(item);
        }
        sink.close();
        Graph out;
        out.loadFromTextFile(path);
        const auto last = static_cast<mrpt::graphs::TNodeID>(increments_.size());
        PoseGaussian closure;
        closure.mean = truth_.front().inverse() * truth_.back();
        closure.cov = 1e-6 * Matrix6d::Identity();
        mrpt::poses::CPose3DPDFGaussianInf edge;
        edge.copyFrom(toMrpt(closure));
        out.insertEdge(0, last, edge);
        return out;
    }

    /** Root mean square distance of the nodes from where they are [m]. */
    [[nodiscard]] double error(const Graph& graph) const
    {
        double sum = 0;
        for (const auto& [id, pose] : graph.nodes)
        {
            sum += (fromMrpt(pose).translation() - truth_[id].translation()).squaredNorm();
        }
        return std::sqrt(sum / static_cast<double>(truth_.size()));
    }

 private:
    test::GaussianSampler sampler_;
    std::vector<Eigen::Isometry3d> truth_;
    std::vector<PoseGaussian> increments_;
};

/** Gauss-Newton over all nodes but the first, the edges' cov_inv taken in the order of the tangent
 * at the edge's end (optimizerInformation). */
[[nodiscard]] Graph optimised(Graph graph)
{
    const auto numUnknowns = static_cast<Eigen::Index>(6 * (graph.nodes.size() - 1));
    const auto at = [](mrpt::graphs::TNodeID id)
    { return 6 * (static_cast<Eigen::Index>(id) - 1); };
    for (int iteration = 0; iteration < 20; ++iteration)
    {
        Eigen::MatrixXd H = Eigen::MatrixXd::Zero(numUnknowns, numUnknowns);
        Eigen::VectorXd g = Eigen::VectorXd::Zero(numUnknowns);
        for (const auto& [ids, edge] : graph.edges)
        {
            const Eigen::Isometry3d T_a_b =
                fromMrpt(graph.nodes[ids.first]).inverse() * fromMrpt(graph.nodes[ids.second]);
            const Vector6d residual = se3Log(fromMrpt(edge.mean).inverse() * T_a_b);
            const Matrix6d J_a = -adjoint(T_a_b.inverse());
            const Matrix6d W = edge.cov_inv.asEigen();
            const Eigen::Index b = at(ids.second);
            H.block<6, 6>(b, b) += W;
            g.segment<6>(b) += W * residual;
            if (ids.first == 0)
            {
                continue;
            }
            const Eigen::Index a = at(ids.first);
            H.block<6, 6>(a, a) += J_a.transpose() * W * J_a;
            H.block<6, 6>(a, b) += J_a.transpose() * W;
            H.block<6, 6>(b, a) += W * J_a;
            g.segment<6>(a) += J_a.transpose() * W * residual;
        }
        const Eigen::VectorXd step = -H.ldlt().solve(g);
        for (auto& [id, pose] : graph.nodes)
        {
            if (id != 0)
            {
                const Vector6d xi = step.segment<6>(at(id));
                static_cast<mrpt::poses::CPose3D&>(pose) = toMrpt(fromMrpt(pose) * se3Exp(xi));
            }
        }
    }
    return graph;
}

[[nodiscard]] Graph optimisedByMrpt(Graph graph)
{
    mrpt::graphslam::TResultInfoSpaLevMarq info;
    mrpt::graphslam::optimize_graph_spa_levmarq(graph, info);
    return graph;
}

void useOptimizerInformation(Graph& graph)
{
    for (auto& [ids, edge] : graph.edges)
    {
        mrpt::poses::CPose3DPDFGaussian pdf;
        pdf.copyFrom(edge);
        edge.cov_inv = optimizerInformation(pdf);
    }
}

TEST(LoopClosure, ourInformationMatricesCloseItBetterThanIdentity)
{
    const TempDir dir;
    constexpr int kLoops = 10;
    double open = 0, ours = 0, identity = 0, mrptAsLoaded = 0, mrptOurs = 0, mrptIdentity = 0;
    for (unsigned seed = 1; seed <= kLoops; ++seed)
    {
        const Loop loop(seed);
        Graph graph = loop.graph(dir / "loop.graph");
        open += loop.error(graph) / kLoops;
        mrptAsLoaded += loop.error(optimisedByMrpt(graph)) / kLoops;
        useOptimizerInformation(graph);
        ours += loop.error(optimised(graph)) / kLoops;
        mrptOurs += loop.error(optimisedByMrpt(graph)) / kLoops;
        for (auto& [ids, edge] : graph.edges)
        {
            edge.cov_inv.setIdentity();
        }
        identity += loop.error(optimised(graph)) / kLoops;
        mrptIdentity += loop.error(optimisedByMrpt(graph)) / kLoops;
    }
    std::cout << "mean error [m]: open " << open << ", identity " << identity << ", ours " << ours
              << "; MRPT's optimiser: identity " << mrptIdentity << ", as loaded " << mrptAsLoaded
              << ", optimizerInformation " << mrptOurs << "\n";
    EXPECT_LT(identity, 0.6 * open);
    EXPECT_LT(ours, 0.8 * identity);
}
}  // namespace
}  // namespace pointplane
