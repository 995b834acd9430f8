// SPDX-License-Identifier: BSD-3-Clause
#include "GrabberApp.h"
#include "run_program.h"

int main(int argc, char** argv)
{
    return pointplane::runProgram("pointplane-grabber", pointplane::runGrabber, argc, argv);
}
