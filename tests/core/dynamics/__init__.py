"""The parts of joint torque, held against engines that are not ours and against the laws of mechanics."""
