// SPDX-License-Identifier: BSD-3-Clause
#include "SimulateApp.h"
#include "run_program.h"

int main(int argc, char** argv)
{
    return pointplane::runProgram("pointplane-simulate", pointplane::runSimulate, argc, argv);
}
