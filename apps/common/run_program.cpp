// SPDX-License-Identifier: BSD-3-Clause
#include "run_program.h"

#include <pointplane/mrpt_io/errors.h>

#include <opencv2/core.hpp>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <iostream>
#include <memory>
#include <new>
#include <system_error>

#include <CLI/CLI.hpp>
#include <pthread.h>
#include <sys/resource.h>

namespace pointplane
{
namespace
{
constexpr std::size_t kStackBytes = 8U << 20U;  // Linux's usual one

struct Call
{
    Program program;
    std::vector<std::string> args;
    int code{kExitEnvironment};
};

void* runCall(void* data)
{
    auto& call = *static_cast<Call*>(data);
    call.code = call.program(call.args, std::cout, std::cerr);
    return nullptr;
}

[[nodiscard]] bool stackIsSmall()
{
    rlimit limit = {};
    return ::getrlimit(RLIMIT_STACK, &limit) == 0 && limit.rlim_cur < kStackBytes;
}

/** In a thread with a stack of the usual size, as have all threads from here on. */
void runOnOwnStack(Call& call)
{
    pthread_attr_t attributes;
    pthread_t thread = {};
    ::pthread_attr_init(&attributes);
    ::pthread_attr_setstacksize(&attributes, kStackBytes);
    ::pthread_setattr_default_np(&attributes);
    const int error = ::pthread_create(&thread, &attributes, runCall, &call);
    ::pthread_attr_destroy(&attributes);
    if (error != 0)
    {
        throw std::system_error(error, std::generic_category(), "no memory for a stack");
    }
    ::pthread_join(thread, nullptr);
}

/** Help without the values that CLI11 puts behind the names of flags: --wait{1e9}. */
class HelpFormatter : public CLI::Formatter
{
 public:
    [[nodiscard]] std::string make_option_name(
        const CLI::Option* option, bool isPositional) const override
    {
        const std::string name = CLI::Formatter::make_option_name(option, isPositional);
        return name.substr(0, name.find('{'));
    }
};

/** Of the current exception. \return the exit code */
int report(const std::string& program, std::ostream& err)
{
    const auto say = [&](const std::string& text, int code)
    {
        err << program << ": " << text << "\n";
        return code;
    };
    try
    {
        throw;
    }
    catch (const EnvironmentError& e)
    {
        return say(e.what(), kExitEnvironment);
    }
    catch (const std::bad_alloc&)
    {
        return say("out of memory", kExitEnvironment);
    }
    catch (const cv::Exception& e)
    {
        return e.code == cv::Error::StsNoMem ? say("out of memory", kExitEnvironment)
                                             : say(oneLine(e), kExitBadInput);
    }
    catch (const std::system_error& e)
    {
        return say(e.what(), kExitEnvironment);
    }
    catch (const std::exception& e)
    {
        return say(oneLine(e), kExitBadInput);
    }
}
}  // namespace

int runCommand(
    CLI::App& app,
    const std::vector<std::string>& args,
    std::ostream& out,
    std::ostream& err,
    const std::function<int()>& body)
{
    app.failure_message([](const CLI::App* a, const CLI::Error& e)
                        { return a->get_name() + ": " + e.what() + " (see --help)\n"; });
    const auto formatter = std::make_shared<HelpFormatter>();
    app.formatter(formatter);
    for (CLI::App* command : app.get_subcommands({}))
    {
        command->formatter(formatter);
    }
    try
    {
        app.parse(std::vector<std::string>(args.rbegin(), args.rend()));  // CLI11: last first
        return body();
    }
    catch (const CLI::ParseError& e)
    {
        return app.exit(e, out, err) == 0 ? kExitOk : kExitBadInput;
    }
    catch (...)
    {
        return report(app.get_name(), err);
    }
}

int runProgram(const char* name, Program program, int argc, char** argv)
{
    std::signal(SIGXFSZ, SIG_IGN);  // ulimit -f: writing fails instead
    Call call{program, {argv + 1, argv + argc}};
    try
    {
        stackIsSmall() ? runOnOwnStack(call) : (void)runCall(&call);
        errno = 0;
        if (!std::cout.flush())
        {
            throw EnvironmentError(
                std::string("cannot write to the standard output") +
                (errno != 0 ? std::string(": ") + std::strerror(errno) : std::string()));
        }
    }
    catch (...)
    {
        return report(name, std::cerr);
    }
    return call.code;
}
}  // namespace pointplane
