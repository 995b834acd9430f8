// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/odometry/Odometry.h>

namespace pointplane
{
struct Odometry::Impl
{
    OdometryParams params;
    FrameFeatures features;
    PoseGaussian pose;
};

void OdometryParams::check() const { depthNoise.check(); }

const char* toString(TrackingStatus status)
{
    switch (status)
    {
        case TrackingStatus::First:
            return "first";
        case TrackingStatus::Tracked:
            return "tracked";
        case TrackingStatus::Predicted:
            return "predicted";
        case TrackingStatus::Lost:
            break;
    }
    return "lost";
}

Odometry::Odometry(const OdometryParams& params) : impl_(std::make_unique<Impl>())
{
    params.check();
    impl_->params = params;
}
Odometry::~Odometry() = default;
Odometry::Odometry(Odometry&&) noexcept = default;
Odometry& Odometry::operator=(Odometry&&) noexcept = default;

OdometryResult Odometry::process(const RgbdFrame& frame)
{
    OdometryResult out;
    out.stamp = frame.stamp;
    out.increment.cov = Matrix6d::Identity() * 1e-6;
    impl_->pose = compose(impl_->pose, out.increment);
    out.pose = impl_->pose;
    return out;
}
const FrameFeatures& Odometry::features() const { return impl_->features; }
const OdometryParams& Odometry::params() const { return impl_->params; }
void Odometry::reset() { *impl_ = Impl{impl_->params, {}, {}}; }
}  // namespace pointplane
