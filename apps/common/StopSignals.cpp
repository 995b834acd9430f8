// SPDX-License-Identifier: BSD-3-Clause
#include "StopSignals.h"

#include <csignal>
#include <initializer_list>

namespace pointplane
{
namespace
{
volatile std::sig_atomic_t stopFlag = 0;

void onSignal(int /*number*/) { stopFlag = 1; }
}  // namespace

void installStopSignals()
{
    stopFlag = 0;
    struct sigaction action
    {
    };
    action.sa_handler = onSignal;
    action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
    for (const int number : {SIGINT, SIGTERM})
    {
        sigaction(number, &action, nullptr);
    }
    struct sigaction before
    {
    };
    sigaction(SIGHUP, nullptr, &before);
    if (before.sa_handler != SIG_IGN)
    {
        sigaction(SIGHUP, &action, nullptr);
    }
}

bool stopRequested() { return stopFlag != 0; }
}  // namespace pointplane
