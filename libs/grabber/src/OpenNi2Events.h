// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <string>

#include "OpenNi2Camera.h"

namespace pointplane
{
/** Unplugging and the end of a file, which frames never tell. */
class OpenNi2Camera::Events : public openni::OpenNI::DeviceDisconnectedListener,
                              public openni::OpenNI::DeviceStateChangedListener
{
 public:
    explicit Events(std::string uri) : uri_(std::move(uri))
    {
        openni::OpenNI::addDeviceDisconnectedListener(this);
        openni::OpenNI::addDeviceStateChangedListener(this);
    }
    ~Events()
    {
        openni::OpenNI::removeDeviceDisconnectedListener(this);
        openni::OpenNI::removeDeviceStateChangedListener(this);
    }
    Events(const Events&) = delete;
    Events& operator=(const Events&) = delete;

    void onDeviceDisconnected(const openni::DeviceInfo* info) override
    {
        disconnected = disconnected || uri_ == info->getUri();
    }
    void onDeviceStateChanged(const openni::DeviceInfo* info, openni::DeviceState state) override
    {
        atEnd = atEnd || (state == openni::DEVICE_STATE_EOF && uri_ == info->getUri());
    }

    std::atomic<bool> disconnected{false};
    std::atomic<bool> atEnd{false};

 private:
    const std::string uri_;
};
}  // namespace pointplane
