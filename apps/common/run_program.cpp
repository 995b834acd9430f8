// SPDX-License-Identifier: BSD-3-Clause
#include "run_program.h"

#include <pointplane/mrpt_io/errors.h>

#include <opencv2/core/utility.hpp>

#include <algorithm>
#include <csignal>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "HelpFormatter.h"
#include "number_checks.h"
#include "standard_streams.h"
#include <CLI/CLI.hpp>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

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

/** -o "$OUT" without an OUT is a mistake, not an output that nobody wants. */
[[nodiscard]] CLI::Validator isNotEmpty()
{
    return {
        [](const std::string& text) { return std::string(text.empty() ? "is empty" : ""); }, ""};
}

/** CLI11 says of an unknown command that none was given. \return empty: there is no such mistake */
[[nodiscard]] std::string problemOfCommand(
    const std::vector<CLI::App*>& commands, const std::vector<std::string>& args)
{
    std::string known;
    for (const CLI::App* command : commands)
    {
        known += (known.empty() ? "" : ", ") + command->get_name();
        if (!args.empty() && (args[0].rfind('-', 0) == 0 || command->get_name() == args[0]))
        {
            return "";
        }
    }
    return known.empty() ? ""
                         : (args.empty() ? "no command" : "unknown command '" + args[0] + "'") +
                               "; commands are " + known;
}

/** CLI11 tells unexpected words last first, and says "At Most 1 required but received 2". */
[[nodiscard]] std::string problemOf(
    const CLI::App& app, const CLI::Error& e, const std::vector<std::string>& args)
{
    const bool hasCommands = !app.get_subcommands([](const CLI::App*) { return true; }).empty();
    if (hasCommands && !app.remaining().empty() && args[0].rfind('-', 0) == 0)
    {
        return args[0] + " stands before the command; options of a command come after its name";
    }
    if (dynamic_cast<const CLI::ExtrasError*>(&e) != nullptr)
    {
        std::string words;
        for (const std::string& word : app.remaining(true))
        {
            words += " " + word;
        }
        return "not expected:" + words;
    }
    const std::string text = e.what();
    const std::size_t at = text.find(": At Most 1 required but received ");
    return at == std::string::npos ? text : text.substr(0, at) + " is given more than once";
}

/** For a terminal, whatever the names and the input hold that it quotes: one line, unless the text
 * is one of our own in several lines. */
[[nodiscard]] std::string printable(std::string text, bool keepsLines = false)
{
    constexpr std::size_t kLongest = 1000;
    if (text.size() > kLongest)
    {
        text = text.substr(0, kLongest) + "...";
    }
    std::replace_if(
        text.begin(),
        text.end(),
        [keepsLines](unsigned char c)
        { return (c < 0x20 || c == 0x7f) && !(keepsLines && c == '\n'); },
        '?');
    return text;
}

/** Whole numbers are whole, and nothing is empty. */
void checkValues(CLI::App& command)
{
    for (CLI::Option* option : command.get_options())
    {
        const std::string type = option->get_type_name();
        if (type.rfind("INT", 0) == 0 || type.rfind("UINT", 0) == 0)
        {
            option->transform(isWhole(type[0] == 'I'));
        }
        option->check(isNotEmpty());
    }
}

/** Of the current exception. \return the exit code */
int report(const std::string& program, std::ostream& err)
{
    const auto say = [&](const std::string& text, int code)
    {
        err << program << ": " << printable(text) << "\n";
        return code;
    };
    try
    {
        throw;
    }
    catch (const EnvironmentError& e)
    {
        // Which cameras there are, and what to do about it, is a list.
        err << program << ": " << printable(e.what(), true) << "\n";
        return kExitEnvironment;
    }
    catch (const InputError& e)
    {
        return say(e.what(), kExitBadInput);
    }
    catch (const std::system_error& e)
    {
        return say(e.what(), kExitEnvironment);
    }
    // What libs/evaluation and libs/simulation refuse of options and trajectories: they know no
    // InputError.
    catch (const std::invalid_argument& e)
    {
        return say(oneLine(e), kExitBadInput);
    }
    catch (const std::runtime_error& e)
    {
        return say(oneLine(e), kExitBadInput);
    }
    catch (const std::exception& e)
    {
        // Nothing of the kind is thrown for what a user gave: it is a bug, not his mistake.
        return say((isOutOfMemory(e) ? "" : "internal error: ") + oneLine(e), kExitEnvironment);
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
    app.failure_message(
        [&args](const CLI::App* a, const CLI::Error& e)
        { return a->get_name() + ": " + printable(problemOf(*a, e, args)) + " (see --help)\n"; });
    std::vector<CLI::App*> commands = app.get_subcommands({});
    const std::string problem = problemOfCommand(commands, args);
    if (!problem.empty())
    {
        err << app.get_name() << ": " << printable(problem) << " (see --help)\n";
        return kExitBadInput;
    }
    commands.push_back(&app);
    const std::size_t columns = &out == &std::cout ? helpColumns() : 0;
    for (CLI::App* command : commands)
    {
        command->formatter(std::make_shared<HelpFormatter>(columns));
        checkValues(*command);
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
    openStandardStreams();
    // ulimit -f, and a reader that leaves: writing fails instead.
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
    // Programs have threads of their own: OpenCV's make nothing faster (on two cores), and where
    // memory is short, those of oneTBB hang or end the program.
    cv::setNumThreads(1);
    Call call{program, {}};
    try
    {
        call.args.assign(argv + 1, argv + argc);
        stackIsSmall() ? runOnOwnStack(call) : (void)runCall(&call);
        flushStandardOutput();
    }
    catch (...)
    {
        return report(name, std::cerr);
    }
    return call.code;
}
}  // namespace pointplane
