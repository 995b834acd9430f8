// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/mrpt_io/SimplemapWriter.h>

#include <mrpt/poses/CPose3D.h>

#include <optional>
#include <string>

#include "text_sinks.h"

namespace pointplane
{
/** Key frames with pose PDF and point cloud: a tracked frame that is far enough from the one
 * before, in translation or rotation. */
class SimplemapSink : public Sink
{
 public:
    /** \param distance [m] \param angleDeg [deg] */
    SimplemapSink(const std::string& path, double distance, double angleDeg);

    void add(const OutputItem& item) override;
    void close() override { writer_.close(); }
    void discard() noexcept override { writer_.discard(); }
    [[nodiscard]] std::string description() const override;

 private:
    std::string path_;
    double distance_;
    double angleDeg_;
    SimplemapWriter writer_;
    std::optional<mrpt::poses::CPose3D> latest_;
};

/** A pose graph of all frames in the text format of TORO, which graph-slam and
 * CNetworkOfPoses3DInf::loadFromTextFile() read: a node per frame, an edge per increment with the
 * inverse of its covariance. Angles roll, pitch, yaw. */
class GraphSink : public TextSink
{
 public:
    explicit GraphSink(const std::string& path);

    void add(const OutputItem& item) override;
    [[nodiscard]] std::string description() const override;

 private:
    std::size_t numNodes_{0};
};
}  // namespace pointplane
