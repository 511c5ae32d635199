"""`ros2 bag`: recordings; a file a verb."""

from ros2.verb import verb
from ros2.verbs.bag import info, play, record

verb("bag info", info.SUMMARY, info.arguments)(info.main)
verb("bag play", play.SUMMARY, play.arguments)(play.main)
verb("bag record", record.SUMMARY, record.arguments)(record.main)
