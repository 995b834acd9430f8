// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace pointplane
{
constexpr double kTwoPi = 6.283185307179586;
}
