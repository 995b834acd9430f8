// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sstream>
#include <stdexcept>

/** Throws std::invalid_argument with a message when a caller breaks a precondition. The message is
 * a stream expression: POINTPLANE_CHECK(n > 0, "n is " << n). */
#define POINTPLANE_CHECK(condition, message)                           \
    do                                                                 \
    {                                                                  \
        if (!(condition))                                              \
        {                                                              \
            std::ostringstream pointplaneCheckMessage;                 \
            pointplaneCheckMessage << message;                         \
            throw std::invalid_argument(pointplaneCheckMessage.str()); \
        }                                                              \
    } while (false)
