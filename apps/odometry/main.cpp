// SPDX-License-Identifier: BSD-3-Clause
#include "OdometryApp.h"
#include "run_program.h"

int main(int argc, char** argv)
{
    return pointplane::runProgram("pointplane-odometry", pointplane::runOdometry, argc, argv);
}
