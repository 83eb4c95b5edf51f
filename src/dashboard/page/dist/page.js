// no page in this build
