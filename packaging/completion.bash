# Completion of pointplane's command lines in bash: subcommands, options and their values as --help
# lists them, keys of --set, else files.
_pointplane_keys() { # PROGRAM: those of its --set, with =
    if [[ $1 == *-simulate ]]; then
        "$1" --list-settings
    else
        "$1" --dump-config
    fi 2>/dev/null |
        awk -v simulates="$([[ $1 == *-simulate ]] && echo 1)" '
            /^\[/ && !simulates {section = substr($1, 2, index($1, "]") - 2) "."}
            $2 == "=" {print section $1 "="}'
}

_pointplane() {
    local cur=${COMP_WORDS[COMP_CWORD]} program=${COMP_WORDS[0]} help command="" word
    local previous=${COMP_WORDS[COMP_CWORD - 1]} values
    help=$(COLUMNS=0 "$program" --help 2>/dev/null) || return
    local commands
    commands=$(sed -n '/^Subcommands:/,$s/^  \([a-z][a-z0-9]*\) .*/\1/p' <<<"$help")
    for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
        if grep -qxF -- "$word" <<<"$commands"; then
            command=$word
            help=$(COLUMNS=0 "$program" "$command" --help 2>/dev/null)
            break
        fi
    done
    COMPREPLY=()
    if [[ $cur == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(grep -oE '(^|[ ,])--?[a-zA-Z][a-z0-9-]*' <<<"$help" |
            tr -d ' ,')" -- "$cur")
    elif [[ $previous == --set ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(_pointplane_keys "$program")" -- "$cur")
        compopt -o nospace 2>/dev/null || true # the value follows
    elif [[ $previous == -* ]]; then
        values=$(sed -nE "s/^ +(-[a-zA-Z],)?$previous TEXT:\{([^}]*)\}.*/\2/p" <<<"$help")
        mapfile -t COMPREPLY < <(compgen -W "${values//,/ }" -- "$cur")
    elif [[ -n $commands && -z $command ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$commands" -- "$cur")
    elif [[ $program == *-simulate ]]; then
        values=$(sed -nE 's/^ {20,}([a-z_]+): .*/\1/p' <<<"$help") # scenes
        mapfile -t COMPREPLY < <(compgen -W "$values" -- "$cur")
    fi
}
complete -o default -F _pointplane pointplane-convert pointplane-eval pointplane-grabber \
    pointplane-odometry pointplane-simulate
