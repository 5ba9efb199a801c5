# Completion of touchtrial for fish, from the table that bash's completion explains.
function __touchtrial_complete
    set -l words (commandline -opc)
    set -q __touchtrial_table; or set -g __touchtrial_table ($words[1] reference --table 2>/dev/null)
    set -l current (commandline -ct)
    set -l place ''
    for word in $words[2..-1]
        string match -q -- '-*' $word; and continue
        string match -q -- "$place|$word|*" $__touchtrial_table; or continue
        set place (string trim -- "$place $word")
    end
    set -l offered
    for row in $__touchtrial_table
        set -l parts (string split -m 3 '|' -- $row)
        test (count $parts) = 4; and test "$parts[1]" = "$place"; or continue
        if test "$parts[2]" = "$words[-1]"; and test "$parts[3]" != -
            set offered (string split -n ' ' -- $parts[3])
            break
        else if test -z "$parts[2]"
            set -a offered (string split -n ' ' -- $parts[3])
        else if string match -q -- '-*' $current; or not string match -q -- '-*' $parts[2]
            set -a offered $parts[2]\t$parts[4]
        end
    end
    if set -q offered[1]
        printf '%s\n' $offered
    else
        __fish_complete_path $current
    end
end
complete -c touchtrial -f -a '(__touchtrial_complete)'
