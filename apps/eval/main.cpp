// SPDX-License-Identifier: BSD-3-Clause
#include "EvalApp.h"
#include "run_program.h"

int main(int argc, char** argv)
{
    return pointplane::runProgram("pointplane-eval", pointplane::runEval, argc, argv);
}
