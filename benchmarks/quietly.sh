# Sourced by the scripts that write tables; needs $work, a folder for temporary files.

# quietly COMMAND...: says what went wrong, nothing else.
quietly() {
    "$@" >"$work/log" 2>&1 || {
        printf 'error: %s\n' "$*" >&2
        cat "$work/log" >&2
        return 1
    }
}
