// SPDX-License-Identifier: BSD-3-Clause
#include "LabApp.h"
#include "run_program.h"

int main(int argc, char** argv)
{
    return pointplane::runProgram("pointplane-lab", pointplane::runLab, argc, argv);
}
