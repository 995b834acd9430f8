# Completion of pointplane's command lines in bash: subcommands and options as --help lists them, else
# files.
_pointplane() {
    local cur=${COMP_WORDS[COMP_CWORD]} program=${COMP_WORDS[0]} help command="" word
    help=$("$program" --help 2>/dev/null) || return
    local commands
    commands=$(sed -n '/^Subcommands:/,$s/^  \([a-z][a-z0-9]*\) .*/\1/p' <<<"$help")
    for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
        if grep -qxF -- "$word" <<<"$commands"; then
            command=$word
            help=$("$program" "$command" --help 2>/dev/null)
            break
        fi
    done
    COMPREPLY=()
    if [[ $cur == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(grep -oE '(^|[ ,])--?[a-zA-Z][a-z0-9-]*' <<<"$help" |
            tr -d ' ,')" -- "$cur")
    elif [[ -n $commands && -z $command ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$commands" -- "$cur")
    fi
}
complete -o default -F _pointplane pointplane-convert pointplane-eval pointplane-grabber \
    pointplane-odometry pointplane-simulate
