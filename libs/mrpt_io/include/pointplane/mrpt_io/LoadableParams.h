// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/trimmed.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/params_ini.h>

#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/config/CLoadableOptions.h>

#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace pointplane
{
/** A parameter group as MRPT's CLoadableOptions: it loads, saves and prints like any other of an
 * MRPT program. Loading is as strict as parseIni(): it throws InputError naming section and key,
 * for an unknown key, or for a value that the key does not take. Values are then as before. */
template <class Group>
class LoadableParams : public mrpt::config::CLoadableOptions
{
 public:
    Group values;

    void loadFromConfigFile(
        const mrpt::config::CConfigFileBase& source, const std::string& section) override
    {
        std::vector<std::string> keys;
        source.getAllKeys(section, keys);
        Group loaded = values;
        const ParameterTable table = parametersOf(section, loaded);
        for (const std::string& key : keys)
        {
            const std::string text = source.read_string(section, key, "");
            parameterOf(table, section, key).set(trimmed(text.substr(0, text.find("//"))));
        }
        try
        {
            loaded.check();
        }
        catch (const std::invalid_argument& e)
        {
            throw InputError("[" + section + "] " + e.what());
        }
        values = loaded;
    }

    void saveToConfigFile(
        mrpt::config::CConfigFileBase& target, const std::string& section) const override
    {
        Group copy = values;
        for (const auto& p : parametersOf(section, copy))
        {
            target.write(section, p.key, p.text(), -1, -1, "[" + p.unit + "] " + p.help);
        }
    }

    void dumpToTextStream(std::ostream& out) const override
    {
        Group copy = values;
        out << iniText(parametersOf("parameters", copy));
    }
};
}  // namespace pointplane
