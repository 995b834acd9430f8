// SPDX-License-Identifier: BSD-3-Clause
#include "ConvertApp.h"
#include "run_program.h"

int main(int argc, char** argv)
{
    return pointplane::runProgram("pointplane-convert", pointplane::runConvert, argc, argv);
}
